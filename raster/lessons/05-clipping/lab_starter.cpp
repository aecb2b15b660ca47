// Your clipping. Write the functions from the top down: each needs the one before it.
#include "raster/lessons/05-clipping/lab.h"

namespace duet::lab {

float crossing_fraction(float front_z, float behind_z) {
    not_attempted(); // Remove this line when you start.
    (void)front_z, (void)behind_z;
    // z changes evenly from front_z to behind_z. At which fraction of the way is it 0?
    return 0;
}

Vertex crossing(const Vertex& a, const Vertex& b) {
    not_attempted(); // Remove this line when you start.
    (void)b;
    // Which of the two is in front? Always go from that one to the other.
    return a;
}

std::vector<Triangle> clip_near(const Triangle& triangle) {
    not_attempted(); // Remove this line when you start.
    // For now triangles are kept or dropped as a whole. Walk around the corners instead: collect those in front, and
    // the crossings of the edges. Then make triangles of the outline.
    for (const Vertex& corner : triangle)
        if (corner.clip.z < 0) return {};
    return {triangle};
}

} // namespace duet::lab

// Clipping at the near plane by a walk around the triangle.
#include "raster/lessons/05-clipping/lab.h"

namespace duet::lab {

float crossing_fraction(float front_z, float behind_z) {
    const float whole = front_z - behind_z;
    return front_z / whole;
}

bool in_front(const Vertex& v) { return v.clip.z >= 0; }

Vertex crossing(const Vertex& a, const Vertex& b) {
    const Vertex front = in_front(a) ? a : b;
    const Vertex behind = in_front(a) ? b : a;
    const float t = crossing_fraction(front.clip.z, behind.clip.z);
    Vertex result;
    result.clip = front.clip * (1 - t) + behind.clip * t;
    result.uv = front.uv * (1 - t) + behind.uv * t;
    return result;
}

std::vector<Triangle> clip_near(const Triangle& triangle) {
    std::vector<Vertex> outline;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex corner = triangle[i];
        const Vertex next = triangle[(i + 1) % 3];
        if (in_front(corner)) outline.push_back(corner);
        if (in_front(corner) != in_front(next)) outline.push_back(crossing(corner, next));
    }
    std::vector<Triangle> result;
    if (outline.size() >= 3) result.push_back({outline[0], outline[1], outline[2]});
    if (outline.size() == 4) result.push_back({outline[0], outline[2], outline[3]});
    return result;
}

} // namespace duet::lab

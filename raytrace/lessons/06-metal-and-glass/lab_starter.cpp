// Lab 06: metal and glass. Begin with mirror; scatter_glass needs mirror, refract and schlick.
#include "raytrace/lessons/06-metal-and-glass/lab.h"

namespace duet::lab {

Vec3 mirror(Vec3 d, Vec3 n) {
    not_attempted(); // Remove this line when you start.
    (void)d;
    // The part of d along the normal turns around. The rest stays.
    return n;
}

std::optional<Vec3> refract(Vec3 d, Vec3 n, float ratio) {
    not_attempted(); // Remove this line when you start.
    (void)n, (void)ratio;
    // Make d 1 long first. What are the cosine of its angle, and the squared sine on the other side?
    return normalize(d); // The ray goes straight on: glass is invisible.
}

float schlick(float cosine, float ior) {
    not_attempted(); // Remove this line when you start.
    (void)cosine, (void)ior;
    return 0.5f;
}

std::optional<Vec3> scatter_metal(Vec3 d, Vec3 n, float fuzz, Vec3 u) {
    not_attempted(); // Remove this line when you start.
    (void)d, (void)fuzz, (void)u;
    return n;
}

Vec3 scatter_glass(Vec3 d, Vec3 n, bool front, float ior, float choice) {
    not_attempted(); // Remove this line when you start.
    (void)n, (void)front, (void)ior, (void)choice;
    return d;
}

} // namespace duet::lab

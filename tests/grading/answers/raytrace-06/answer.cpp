// Mirrors, metal and glass.
#include "raytrace/lessons/06-metal-and-glass/lab.h"

namespace duet::lab {

Vec3 mirror(Vec3 d, Vec3 n) { return d - 2.0f * dot(d, n) * n; }

std::optional<Vec3> refract(Vec3 d, Vec3 n, float ratio) {
    const Vec3 unit = normalize(d);
    const float cos_in = -dot(unit, n);
    const Vec3 across = ratio * (unit + cos_in * n); // as long as the sine of the angle beyond
    const float sin2_out = length_squared(across);
    if (sin2_out > 1) return std::nullopt;
    const float cos_out = std::sqrt(1 - sin2_out);
    return across - cos_out * n;
}

float schlick(float cosine, float ior) {
    const float root = (ior - 1) / (ior + 1);
    const float r0 = root * root;
    const float x = 1 - cosine;
    return r0 + (1 - r0) * x * x * x * x * x;
}

std::optional<Vec3> scatter_metal(Vec3 d, Vec3 n, float fuzz, Vec3 u) {
    const Vec3 direction = normalize(mirror(d, n)) + fuzz * u;
    if (dot(direction, n) <= 0) return std::nullopt;
    return direction;
}

Vec3 scatter_glass(Vec3 d, Vec3 n, bool front, float ior, float choice) {
    d = normalize(d);
    const float ratio = front ? 1 / ior : ior;
    const auto bent = refract(d, n, ratio);
    if (!bent) return mirror(d, n);
    const float cosine = ratio < 1 ? -dot(d, n) : -dot(*bent, n); // in the thinner medium
    if (choice < schlick(cosine, ior)) return mirror(d, n);
    return *bent;
}

} // namespace duet::lab

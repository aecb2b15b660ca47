#include "common/geometry/sphere.h"

#include <cmath>

namespace duet {

std::optional<float> intersect_sphere(const Ray& ray, const Sphere& sphere) {
    const SphereTest<double> test(Vec3d(sphere.center) - Vec3d(ray.origin),
                                  SphereTestLine<double>(Vec3d(ray.direction)), static_cast<double>(sphere.radius));
    if (!(test.discriminant >= 0)) return std::nullopt;
    const auto [near, far] = test.roots();
    const float t_near = static_cast<float>(near), t_far = static_cast<float>(far);
    if (t_near > ray.t_min && t_near <= ray.t_max) return t_near;
    if (t_far > ray.t_min && t_far <= ray.t_max) return t_far;
    return std::nullopt;
}

Vec2 sphere_uv(Vec3 n) {
    const double u = 0.5 + std::atan2(static_cast<double>(n.x), static_cast<double>(n.z)) / (2 * kPiDouble);
    // atan2 is accurate at the poles, where acos(y) is not.
    const double v =
        0.5 + std::atan2(static_cast<double>(n.y), std::hypot(static_cast<double>(n.x), static_cast<double>(n.z))) /
                  kPiDouble;
    return {min(static_cast<float>(u), kOneMinusEpsilon), static_cast<float>(v)};
}

Vec3 sphere_direction(Vec2 uv) {
    const double longitude = (static_cast<double>(uv.x) - 0.5) * 2 * kPiDouble;
    const double latitude = (static_cast<double>(uv.y) - 0.5) * kPiDouble;
    const double ring_radius = std::cos(latitude);
    return Vec3(Vec3d(ring_radius * std::sin(longitude), std::sin(latitude), ring_radius * std::cos(longitude)));
}

// An environment map is seen from inside, which exchanges left and right. Negating z mirrors the direction accordingly.
Vec2 latlong_uv(Vec3 w) { return sphere_uv({w.x, w.y, -w.z}); }

} // namespace duet

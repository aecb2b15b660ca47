// The library's sphere (common/geometry/sphere.cpp).
#include "common/geometry/sphere.h"
#include "raytrace/lessons/02-sphere/lab.h"

namespace duet::lab {

std::optional<float> hit_sphere(Vec3 center, float radius, const Ray& ray) {
    return intersect_sphere(ray, {center, radius});
}

Vec3 sphere_normal(Vec3 center, float, Vec3 p) { return normalize(p - center); }

Rgb normal_color(Vec3 n) { return direction_color(n); }

/// Seen from above, ray and cylinder are a ray and a circle: a sphere that is cut through its middle.
std::optional<float> hit_cylinder(float radius, const Ray& ray) {
    const Vec3 origin{ray.origin.x, 0, ray.origin.z}, direction{ray.direction.x, 0, ray.direction.z};
    if (direction == Vec3{0, 0, 0}) return std::nullopt;
    return intersect_sphere({origin, direction, ray.t_min, ray.t_max}, {{0, 0, 0}, radius});
}

} // namespace duet::lab

// Where a ray meets a sphere.
#pragma once

#include "common/vec/ray.h"

#include <optional>

namespace duet::lesson {

struct Sphere {
    Vec3 center;
    float radius = 1;
};

/// The distance t of the nearest point of the sphere on the ray, t_min < t < t_max; nothing where the ray misses.
/// A point p lies on the sphere where |p - center|² = radius². With p = origin + t·direction that is the quadratic
/// a·t² + 2·b·t + c = 0. (Ray Tracing in One Weekend, §5 and §6.2)
inline std::optional<float> hit_sphere(const Sphere& sphere, const Ray& ray) {
    const Vec3 to_origin = ray.origin - sphere.center;
    const float a = dot(ray.direction, ray.direction);
    const float b = dot(to_origin, ray.direction);
    const float c = dot(to_origin, to_origin) - sphere.radius * sphere.radius;
    const float discriminant = b * b - a * c;
    if (discriminant < 0) return std::nullopt; // no real root: the ray passes the sphere by
    const float root = std::sqrt(discriminant);
    for (const float t : {(-b - root) / a, (-b + root) / a}) // the nearer point first
        if (t > ray.t_min && t < ray.t_max) return t;
    return std::nullopt;
}

} // namespace duet::lesson

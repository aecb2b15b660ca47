// A ray and a sphere by the quadratic formula.
#include "raytrace/lessons/02-sphere/lab.h"

namespace duet::lab {

std::optional<float> hit_sphere(Vec3 center, float radius, const Ray& ray) {
    const Vec3 q = ray.origin - center;
    const float a = dot(ray.direction, ray.direction);
    const float b = dot(q, ray.direction);
    const float c = dot(q, q) - radius * radius;
    const float discriminant = b * b - a * c;
    if (discriminant < 0) return std::nullopt;
    const float root = std::sqrt(discriminant);
    const float near = (-b - root) / a;
    const float far = (-b + root) / a;
    if (near > ray.t_min && near < ray.t_max) return near;
    if (far > ray.t_min && far < ray.t_max) return far;
    return std::nullopt;
}

Vec3 sphere_normal(Vec3 center, float radius, Vec3 p) { return (p - center) / radius; }

Rgb normal_color(Vec3 n) { return {(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2}; }

std::optional<float> hit_cylinder(float radius, const Ray& ray) {
    const float ox = ray.origin.x, oz = ray.origin.z;
    const float dx = ray.direction.x, dz = ray.direction.z;
    const float k2 = dx * dx + dz * dz;
    if (k2 == 0) return std::nullopt;
    const float k1 = ox * dx + oz * dz;
    const float k0 = ox * ox + oz * oz - radius * radius;
    const float inside = k1 * k1 - k2 * k0;
    if (inside < 0) return std::nullopt;
    const float first = (-k1 - std::sqrt(inside)) / k2;
    const float second = (-k1 + std::sqrt(inside)) / k2;
    if (first > ray.t_min && first < ray.t_max) return first;
    if (second > ray.t_min && second < ray.t_max) return second;
    return std::nullopt;
}

} // namespace duet::lab

// This header declares the textbook intersection routines of the suite's naive column. They are short, in float, with
// the usual constants.
#pragma once

#include "common/geometry/shape.h"
#include "common/vec/ray.h"

#include <optional>
#include <utility>

namespace duet::compare::naive {

/// Returns the nearest root in (t_min, t_max] by the textbook quadratic formula (Ray Tracing in One Weekend, §6.2).
inline std::optional<float> intersect_sphere(const Ray& ray, const Sphere& sphere) {
    const Vec3 oc = sphere.center - ray.origin;
    const float a = length_squared(ray.direction), h = dot(ray.direction, oc);
    const float c = length_squared(oc) - sphere.radius * sphere.radius, discriminant = h * h - a * c;
    if (discriminant < 0) return std::nullopt;
    const float root = std::sqrt(discriminant);
    for (const float t : {(h - root) / a, (h + root) / a})
        if (!(t <= ray.t_min || ray.t_max < t)) return t;
    return std::nullopt;
}

/// Returns the ray's hit of a triangle by Möller and Trumbore 1997, figure 1, with their epsilon.
inline std::optional<float> intersect_triangle(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, float epsilon = 1e-6f) {
    const Vec3 ab = b - a, ac = c - a, p = cross(ray.direction, ac);
    const float det = dot(ab, p);
    if (det > -epsilon && det < epsilon) return std::nullopt;
    const Vec3 s = ray.origin - a;
    const float u = dot(s, p) / det;
    if (u < 0 || u > 1) return std::nullopt;
    const Vec3 q = cross(s, ab);
    const float v = dot(ray.direction, q) / det;
    if (v < 0 || u + v > 1) return std::nullopt;
    const float t = dot(ac, q) / det;
    if (t <= ray.t_min || t > ray.t_max) return std::nullopt;
    return t;
}

/// Returns whether a ray intersects a box (Ray Tracing: The Next Week, §3.4).
inline bool intersect_box(const Ray& ray, const Box3& box) {
    float from = ray.t_min, to = ray.t_max;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float inverse = 1 / ray.direction[axis];
        float t0 = (box.low[axis] - ray.origin[axis]) * inverse, t1 = (box.high[axis] - ray.origin[axis]) * inverse;
        if (inverse < 0) std::swap(t0, t1);
        if (t0 > from) from = t0;
        if (t1 < to) to = t1;
        if (to <= from) return false;
    }
    return true;
}

} // namespace duet::compare::naive

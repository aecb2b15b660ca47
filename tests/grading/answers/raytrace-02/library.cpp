// The library's sphere (common/geometry/sphere.cpp).
#include "common/geometry/sphere.h"
#include "raytrace/lessons/02-sphere/lab.h"

namespace duet::lab {

std::optional<float> hit_sphere(Vec3 center, float radius, const Ray& ray) {
    return intersect_sphere(ray, {center, radius});
}

Vec3 sphere_normal(Vec3 center, float, Vec3 p) { return normalize(p - center); }

Rgb normal_color(Vec3 n) { return direction_color(n); }

} // namespace duet::lab

// Ray and sphere.
#pragma once

#include "common/geometry/shape.h"
#include "common/vec/ray.h"

#include <optional>

namespace duet {

/// The nearest t in (t_min, t_max] where the ray meets the sphere, from outside or inside; direction of any length.
/// Without cancellation for far, huge and tiny spheres (Haines, Günther and Akenine-Möller 2019, «Precision
/// Improvements for Ray/Sphere Intersection», Ray Tracing Gems §7).
std::optional<float> intersect_sphere(const Ray& ray, const Sphere& sphere);

/// (u, v) on the unit sphere at direction n: u = ½ + atan2(x, −z)/2π, v = 1 at +y (design: lat-long, v = 0 at bottom).
Vec2 sphere_uv(Vec3 n);
/// The direction of (u, v): the inverse of sphere_uv.
Vec3 sphere_direction(Vec2 uv);

} // namespace duet

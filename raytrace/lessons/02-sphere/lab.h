// Lab 02: a ray meets a sphere.
#pragma once

#include "common/image/rgb.h"
#include "common/vec/ray.h"
#include "tests/grading/lab.h"

#include <optional>

namespace duet::lab {

/// The smallest t with ray.t_min < t < ray.t_max at which the ray meets the sphere; nothing where it doesn't. radius >
/// 0. The ray's direction may have any length but 0.
std::optional<float> hit_sphere(Vec3 center, float radius, const Ray& ray);

/// The unit normal at a point p of the sphere. It points away from the center, also if the ray came from inside.
Vec3 sphere_normal(Vec3 center, float radius, Vec3 p);

/// A unit normal as three numbers of a color: each coordinate moves from [-1, 1] to [0, 1]. No curve of sRGB is asked
/// for here: unlike the lesson's function, this one doesn't decode.
Rgb normal_color(Vec3 n);

/// The same as hit_sphere for a cylinder around the y axis: all points at the distance `radius` from that axis, however
/// high or low. radius > 0. The ray's direction may have any length but 0. A ray that runs along the axis, with x = z =
/// 0 in its direction, meets nothing.
std::optional<float> hit_cylinder(float radius, const Ray& ray);

} // namespace duet::lab

DUET_LAB(hit_sphere, sphere_normal, normal_color, hit_cylinder)

// Lab 11: densities, weights, and light that is looked for.
#pragma once

#include "common/image/rgb.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "tests/grading/lab.h"

namespace duet::lab {

using lesson::Sphere;

/// A number x from 0 to 1 with the density (k + 1)·xᵏ, made from a random number u that is uniform in [0, 1). k ≥ 0.
float draw_power(float k, float u);

/// A flat light: the points corner + a·u + b·v with a and b from 0 to 1; u and v need not be at right angles. It shines
/// on the side to which u × v points, and on that alone.
struct Light {
    Vec3 corner, u, v;
    Rgb emission; ///< radiance
};

/// The point of the light for two random numbers, each uniform in [0, 1): all points of the light are equally likely.
Vec3 sample_quad(const Light& light, Vec2 random);

/// The density, per steradian as seen from p, of the direction to a point q of the light, where q is drawn as by
/// sample_quad. 0 where p is behind the light or in its plane.
float light_density(const Light& light, Vec3 p, Vec3 q);

/// The density, per steradian, of the unit direction w, where directions are drawn by Lambert's law around the unit
/// normal n. 0 where w points into the surface.
float cosine_density(Vec3 n, Vec3 w);

/// A unit direction around n with that density, made from two random numbers, each uniform in [0, 1).
Vec3 cosine_direction(Vec3 n, Vec2 random);

/// The weight, by the power heuristic with exponent 2, of a sample that was drawn with density own, where another way
/// draws it with density other. own > 0, other ≥ 0. Densities may be as large as 1e30.
float mis_weight(float own, float other);

/// One estimate of the direct light that a matte surface with this unit normal and albedo sends out at p: the point of
/// the light that belongs to the two random numbers is looked at from p. Black where the light shines away from p,
/// where its point lies behind the surface, and where a sphere is in between. lesson::closest_hit(spheres, ray) finds
/// the nearest sphere on a ray between ray.t_min and ray.t_max; start the ray at p with t_min = 0.001. The light itself
/// is none of the spheres.
Rgb direct_light(const Light& light, const std::vector<Sphere>& spheres, Vec3 p, Vec3 n, Rgb albedo, Vec2 random);

} // namespace duet::lab

DUET_LAB(draw_power, sample_quad, light_density, cosine_density, cosine_direction, mis_weight, direct_light)

// Lab 10: light sources, quads, boxes of quads.
#pragma once

#include "common/image/rgb.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "raytrace/lessons/04-antialiasing/sampling.h"
#include "raytrace/lessons/05-diffuse/diffuse.h"
#include "tests/grading/lab.h"

namespace duet::lab {

/// A parallelogram: the points corner + a·u + b·v with a and b from 0 to 1. u and v need not be at right angles. Its
/// front is the side to which u × v points. Both sides are matte; the front alone sends out light.
struct Quad {
    Vec3 corner, u, v;
    Rgb albedo{};   ///< the fraction of light that goes on, 0 to 1
    Rgb emission{}; ///< the radiance that the front sends out
};

/// The distance t with ray.t_min < t < ray.t_max at which the ray meets the quad, from either side, in lengths of the
/// ray's direction (which is any but 0); nothing where it misses, and where it runs parallel to the quad.
std::optional<float> hit_quad(const Quad& quad, const Ray& ray);

/// The six sides of the box between two opposite corners, low and high: low is smaller in each coordinate. In any
/// order. All fronts look outward. The emission is black.
std::vector<Quad> box_of_quads(Vec3 low, Vec3 high, Rgb albedo);

/// The radiance that the quad itself sends against the direction of a ray that meets it. The direction has any length
/// but 0, and isn't parallel to the quad.
Rgb emitted(const Quad& quad, Vec3 ray_direction);

/// The nearest hit on the ray: t and p; n, the unit normal on the side from which the ray came; front, whether that is
/// the front; index, which quad of the list. Nothing where there is none.
std::optional<lesson::Hit> closest_hit(const std::vector<Quad>& quads, const Ray& ray);

/// The light that comes along one random path: at each quad that it meets, what that quad sends out, times the albedos
/// of all quads that it met before. The path is reflected at most `bounces` times; with 0 it brings only what the first
/// quad sends out. Where it meets no quad it ends: outside it is dark. Rays after the first start at the hit with
/// t_min = 0.001. lesson::random_diffuse_direction(n, random) draws directions, and lesson::Random random(seed) makes
/// the random numbers. Another seed gives another path.
Rgb path_color(const std::vector<Quad>& quads, const Ray& ray, int bounces, int seed);

} // namespace duet::lab

DUET_LAB(hit_quad, box_of_quads, emitted, closest_hit, path_color)

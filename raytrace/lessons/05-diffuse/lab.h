// Lab 05: matte surfaces.
#pragma once

#include "common/image/rgb.h"
#include "raytrace/lessons/02-sphere/sky.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "raytrace/lessons/04-antialiasing/sampling.h"
#include "tests/grading/lab.h"

namespace duet::lab {

using lesson::Sphere;

/// The value that a file stores for an amount of light, both from 0 to 1, by the curve of sRGB.
float srgb_from_linear(float linear);

/// The point of the unit sphere in the direction of a random point of the cube [-1, 1]³; nothing for points that have
/// to be thrown away, so that all directions are equally likely. (0, 0, 0) has no direction: nothing, too.
std::optional<Vec3> unit_vector(Vec3 cube_point);

/// The direction in which a matte surface of unit normal n sends light, from a random unit vector u. Any length but 0,
/// and never to the other side of the surface; for u = -n the direction is n.
Vec3 diffuse_direction(Vec3 n, Vec3 u);

/// Where a ray in `direction` starts that leaves the surface of unit normal n at p. Each coordinate of p may be wrong
/// by up to that of p_error, which is far larger than a rounding error of p. The start is moved along n, to the side
/// that the direction points to, just so far that it lies on that side for certain: at least the distance between p and
/// the farthest place where the plane can be, and at most twice that.
Vec3 offset_origin(Vec3 p, Vec3 p_error, Vec3 n, Vec3 direction);

/// The light that comes along one random path: lesson::sky_color where it leaves the spheres, times the albedo of each
/// sphere that it met, in between. Black where a path meets more than `bounces` of them. Rays after the first start at
/// the hit with t_min = 0.001. lesson::closest_hit finds hits (albedos[hit.index] belongs to it), and
/// lesson::Random(seed) makes random numbers with next(). Another seed gives another path.
Rgb path_color(const std::vector<Sphere>& spheres, const std::vector<Rgb>& albedos, const Ray& ray, int bounces,
               int seed);

} // namespace duet::lab

DUET_LAB(srgb_from_linear, unit_vector, diffuse_direction, offset_origin, path_color)

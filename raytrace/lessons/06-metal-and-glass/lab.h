// Lab 06: metal and glass.
#pragma once

#include "common/vec/vec.h"
#include "tests/grading/lab.h"

#include <optional>

namespace duet::lab {

/// The direction d mirrored at a surface of unit normal n. d points toward the surface, the result away from it, and
/// both have the same length, which may be any.
Vec3 mirror(Vec3 d, Vec3 n);

/// The direction d bent by Snell's law where it crosses a surface. d points toward the surface and may have any length
/// but 0; its unit normal n is on the side that d comes from. ratio > 0 is the index of refraction on that side,
/// divided by the index beyond. The result has length 1. Nothing where all light is reflected.
std::optional<Vec3> refract(Vec3 d, Vec3 n, float ratio);

/// The fraction of light that a surface between air and a material of index ior > 0 reflects, by Schlick's
/// approximation. cosine, from 0 to 1, is that of the angle between the normal and the ray in the thinner medium.
float schlick(float cosine, float ior);

/// The direction in which metal sends a ray on: the mirror direction of d, made 1 long, plus fuzz times the random unit
/// vector u. Nothing where that points into the metal. d has any length but 0, n is the unit normal on the side of d,
/// and fuzz is from 0 to 1. The result may have any length.
std::optional<Vec3> scatter_metal(Vec3 d, Vec3 n, float fuzz, Vec3 u);

/// The direction in which glass sends a ray on. d has any length but 0, n is the unit normal on the side that d comes
/// from, and front says whether that side is the outside. ior is the index of the inside over that of the outside:
/// above 1 for a glass sphere, below 1 for a bubble. choice is a random number in [0, 1): the ray is reflected where it
/// is less than the fraction of light that schlick says, and where refraction is not possible. Otherwise it is
/// refracted.
Vec3 scatter_glass(Vec3 d, Vec3 n, bool front, float ior, float choice);

} // namespace duet::lab

DUET_LAB(mirror, refract, schlick, scatter_metal, scatter_glass)

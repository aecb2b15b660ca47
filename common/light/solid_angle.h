// Sampling the solid angle that a shape subtends at a point.
#pragma once

#include "common/light/light.h"

#include <optional>

namespace duet {

struct SolidAngleSample {
    Vec3d wi;        ///< unit, from p to the shape
    double distance; ///< to the shape along wi
    double pdf;      ///< by solid angle
};

/// Right angles but for rounding. Other parallelograms are sampled as two triangles where they are near.
bool is_rectangle(const Quad& quad);

// For each shape: a direction from p to it, and the density with which sample_solid_angle returns the direction to its
// point q. Empty, and 0, where p lies in the plane of a flat shape. u in [0, 1)².

/// Near: uniform by solid angle (a quad as a spherical rectangle, or, where its sides are not at right angles, as two
/// triangles). Far: uniform by area, which is nearly the same there.
std::optional<SolidAngleSample> sample_solid_angle(const SurfaceLight::Triangle& triangle, Vec3d p, Vec2d u);
double solid_angle_pdf(const SurfaceLight::Triangle& triangle, Vec3d p, Vec3d q);

std::optional<SolidAngleSample> sample_solid_angle(const Quad& quad, Vec3d p, Vec2d u);
double solid_angle_pdf(const Quad& quad, Vec3d p, Vec3d q);

/// Uniform over the cone that the sphere fills, seen from outside; over all directions from inside.
std::optional<SolidAngleSample> sample_solid_angle(const Sphere& sphere, Vec3d p, Vec2d u);
double solid_angle_pdf(const Sphere& sphere, Vec3d p, Vec3d q);

} // namespace duet

// This file computes the solid angle of a triangle. It also draws directions to a shape from a point, with densities by
// solid angle.
#pragma once

#include "common/geometry/shape.h"
#include "common/light/area_sampling.h"

#include <cmath>
#include <optional>

namespace duet {

/// Holds the corners of a triangle, counter-clockwise seen from its front.
struct LightTriangle {
    Vec3 a, b, c;
};

/// Each overload returns a flat shape as seen from p.
AreaSampling<double> area_seen(const LightTriangle& triangle, Vec3d p);
QuadSeen<double> area_seen(const Quad& quad, Vec3d p);

/// Returns the solid angle of a triangle whose corners are relative to the viewer. It is negative if the viewer sees
/// the front (Van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle"). T is double or a batch of floats.
template <typename T> T solid_angle(Vec3T<T> a, Vec3T<T> b, Vec3T<T> c) {
    using std::atan2;
    const T la = length(a), lb = length(b), lc = length(c);
    return T(2.0f) * atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la);
}

// sample_solid_angle draws a direction from p to the shape, with u in [0, 1)². solid_angle_pdf returns the density
// with which sample_solid_angle draws the direction to the shape's point q. Where p lies in the plane of a flat
// shape, the sample is empty and the density 0.

/// Flat shapes are sampled uniformly by area.
std::optional<SolidAngleSample> sample_solid_angle(const LightTriangle& triangle, Vec3d p, Vec2d u);
/// Returns the density by solid angle, from p, with which sample_solid_angle draws the direction to the point q of the
/// shape.
double solid_angle_pdf(const LightTriangle& triangle, Vec3d p, Vec3d q);

std::optional<SolidAngleSample> sample_solid_angle(const Quad& quad, Vec3d p, Vec2d u);
double solid_angle_pdf(const Quad& quad, Vec3d p, Vec3d q);

/// A sphere is sampled uniformly over the cone that it subtends; from inside, uniformly over all directions.
std::optional<SolidAngleSample> sample_solid_angle(const Sphere& sphere, Vec3d p, Vec2d u);
double solid_angle_pdf(const Sphere& sphere, Vec3d p, Vec3d q);

} // namespace duet

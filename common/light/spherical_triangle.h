// This file computes the solid angle of a triangle on the unit sphere, and samples it uniformly.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// A SphericalTriangle holds the unit vectors from a point to a triangle's corners.
struct SphericalTriangle {
    Vec3d a, b, c;

    /// Returns the solid angle in steradians, in [0, 2π]. The result is accurate for small and for large triangles
    /// (Van Oosterom and Strackee 1983, eq. 8).
    double solid_angle() const;
    /// Draws a direction uniformly over the triangle (Arvo 1995, "Stratified Sampling of Spherical Triangles", §2).
    /// u is in [0, 1)². `solid_angle` is the triangle's own; it must be well above rounding (1e-6) and below 2π.
    Vec3d sample(double solid_angle, Vec2d u) const;
};

} // namespace duet

// Triangles on the unit sphere: their solid angle, and points uniform on them.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// Unit vectors from a point to a triangle's corners.
struct SphericalTriangle {
    Vec3d a, b, c;

    /// Steradians, in [0, 2π]; accurate for small and for large triangles (Van Oosterom and Strackee 1983, eq. 8).
    double solid_angle() const;
    /// A direction uniform over the triangle, of the given solid angle (Arvo 1995, «Stratified Sampling of Spherical
    /// Triangles», §2). u in [0, 1)². The solid angle must be well above rounding (1e-6) and below 2π.
    Vec3d sample(double solid_angle, Vec2d u) const;
};

} // namespace duet

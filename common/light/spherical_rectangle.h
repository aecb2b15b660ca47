// This file computes the solid angle of a rectangle seen from a point, and samples it uniformly.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// A SphericalRectangle is a rectangle projected onto the unit sphere about the origin (Ureña, Fajardo and King
/// 2013, "An Area-Preserving Parametrization for Spherical Rectangles", §3). The computation is in double. The solid
/// angle must be well above rounding (1e-6).
class SphericalRectangle {
public:
    /// `corner` is relative to the viewing point, which must not lie in the rectangle's plane. u and v must be at
    /// right angles.
    SphericalRectangle(Vec3d corner, Vec3d u, Vec3d v);

    /// Returns the solid angle in steradians, in (0, 2π).
    double solid_angle() const { return solid_angle_; }
    /// Returns the point of the rectangle, relative to the viewing point, in a direction drawn uniformly over the
    /// solid angle. The map is continuous, so strata of u in [0, 1)² stay compact.
    Vec3d sample(Vec2d u) const;

private:
    Vec3d x_, y_, z_;                 // the rectangle's axes; z_ points so that the rectangle lies at negative z
    double x0_, x1_, y0_, y1_, z0_;   // the rectangle's extent along the axes
    double b0_, b1_;                  // z of the normals of the planes through the edges at y0 and y1
    double solid_angle_, beyond_left_; // beyond_left_: 2π minus the inner angles at x0 (k in the paper)
};

} // namespace duet

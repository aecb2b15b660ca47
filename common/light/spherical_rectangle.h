// Rectangles seen from a point: their solid angle, and directions uniform over it.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// A rectangle projected on the unit sphere about the origin (Ureña, Fajardo and King 2013, «An Area-Preserving
/// Parametrization for Spherical Rectangles», §3). In double; the solid angle must be well above rounding (1e-6).
class SphericalRectangle {
public:
    /// corner: relative to the point that sees it, which must not lie in its plane; u and v at right angles.
    SphericalRectangle(Vec3d corner, Vec3d u, Vec3d v);

    /// Steradians, in (0, 2π).
    double solid_angle() const { return solid_angle_; }
    /// The point of the rectangle, relative to the one that sees it, in a direction uniform over the solid angle. The
    /// map is continuous: strata of u in [0, 1)² stay compact.
    Vec3d sample(Vec2d u) const;

private:
    Vec3d x_, y_, z_;                 // the rectangle's axes, z_ so that it lies at negative z
    double x0_, x1_, y0_, y1_, z0_;   // its extent along them
    double b0_, b1_;                  // the z of the normals of the planes through the edges at y0 and y1
    double solid_angle_, beyond_left_; // the latter: 2π less the inner angles at x0 (k in the paper)
};

} // namespace duet

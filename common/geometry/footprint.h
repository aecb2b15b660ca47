// This file computes the footprint of a sample of a pixel on a surface and in texture coordinates.
#pragma once

#include "common/geometry/surface_point.h"

namespace duet {

/// The ray differentials dx and dy are the offsets from a ray at its hit to the rays of the neighboring samples in the
/// image's x and y direction (Igehy 1999, "Tracing Ray Differentials"). Their components along the ray have no effect.
struct RayFootprint {
    Vec3 dx, dy;

    friend RayFootprint operator*(const RayFootprint& f, float s) { return {f.dx * s, f.dy * s}; }
};

/// Sets point.duv_dx and point.duv_dy, the change of uv from this sample to its neighbors. The neighboring rays are
/// intersected with the tangent plane of the point, and dpdu and dpdv convert the offsets there to uv. On a triangle,
/// the results equal the derivatives of perspective-correct interpolation. They stay unchanged where the uv are
/// degenerate, and are infinite or NaN where the plane is seen edge-on. `direction` is the direction of the ray.
void set_footprint(const RayFootprint& footprint, Vec3 direction, SurfacePoint& point);

} // namespace duet

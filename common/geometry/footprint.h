// How much of a surface, and of its texture, a pixel's sample stands for.
#pragma once

#include "common/geometry/surface_point.h"

namespace duet {

/// Where the neighbouring samples' rays are, beside a ray at the distance of its hit: one step along the picture's x and
/// y each (Igehy 1999, «Tracing Ray Differentials»). What of it lies along the ray is of no account.
struct RayFootprint {
    Vec3 dx, dy;

    friend RayFootprint operator*(const RayFootprint& f, float s) { return {f.dx * s, f.dy * s}; }
};

/// The steps of texture coordinates on the surface that go with those of the ray: the neighbours meet the point's tangent
/// plane, and dpdu and dpdv say what uv they find there. On a triangle these are the very derivatives of perspective-
/// correct interpolation. (0, 0) where the uv are degenerate; infinite or NaN where the plane is seen edge-on.
void set_footprint(const RayFootprint& footprint, Vec3 direction, SurfacePoint& point);

} // namespace duet

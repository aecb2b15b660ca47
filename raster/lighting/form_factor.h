// Computes the unoccluded irradiance from polygons in closed form.
#pragma once

#include "common/geometry/shape.h"

#include <span>

namespace duet {

/// Returns ∫ max(0, n·w) dw over the solid angle that a convex planar polygon subtends at p, clipped to the
/// hemisphere of n: the irradiance at p per unit of radiance, in [0, π] (Lambert 1760; Arvo 1995, "Analytic Methods
/// for Simulated Light Transport", §4.1.1). The vertices may be in either order: the value is that of the side that
/// faces p. The polygon has at most 8 vertices (an invariant). The computation is in double. The result is 0 where p
/// lies in the polygon's plane.
double polygon_form_factor_times_pi(Vec3 p, Vec3 n, std::span<const Vec3> polygon);
/// This overload takes a quad, whose vertices are not rounded to float.
double polygon_form_factor_times_pi(Vec3 p, Vec3 n, const Quad& quad);

} // namespace duet

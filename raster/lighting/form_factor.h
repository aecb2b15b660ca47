// This file computes the unoccluded irradiance from polygons and spheres in closed form.
#pragma once

#include "common/image/rgb.h"
#include "common/light/light.h"

#include <span>

namespace duet {

/// Returns ∫ max(0, n·w) dw over the solid angle that a convex planar polygon subtends at p, clipped to the
/// hemisphere of n: the irradiance at p per unit of radiance, in [0, π] (Lambert 1760; Arvo 1995, "Analytic Methods
/// for Simulated Light Transport", §4.1.1). The vertices may be in either order: the value is that of the side that
/// faces p. The polygon has at most 8 vertices (an invariant). The computation is in double. The result is 0 where p
/// lies in the polygon's plane.
double polygon_form_factor_times_pi(Vec3 p, Vec3 n, std::span<const Vec3> polygon);
/// Returns the irradiance at p per unit of radiance of a sphere, its visible cap clipped to the hemisphere of n, in
/// [0, π] (Snyder 1996, "Area Light Sources for Real-Time Graphics", §A). The result is π where p is inside or on
/// the sphere, which then fills the hemisphere.
double sphere_form_factor_times_pi(Vec3 p, Vec3 n, const Sphere& sphere);

/// Returns the unoccluded irradiance at p with normal n from an emissive surface, W/m². It is black where p is not
/// on an emitting side. A point of the light's own surface lies in its plane only up to rounding, so callers must
/// skip a surface's own light.
Rgb surface_light_irradiance(const SurfaceLight& light, Vec3 p, Vec3 n);

} // namespace duet

// Irradiance from polygons and spheres in closed form, nothing in between.
#pragma once

#include "common/image/rgb.h"
#include "common/light/light.h"

#include <span>

namespace duet {

/// ∫ max(0, n·w) dw over the solid angle that a convex planar polygon subtends at p, clipped to the horizon of n: the
/// irradiance at p per unit of radiance, in [0, π]. Vertices in either order: the value is that of the side facing p.
/// Lambert 1760; Arvo 1995, «Analytic Methods for Simulated Light Transport», §4.1.1. Computed in double. Up to 8
/// vertices (an invariant). 0 where p lies in the polygon's own plane.
double polygon_form_factor_times_pi(Vec3 p, Vec3 n, std::span<const Vec3> polygon);
/// The same of a sphere, its visible cap clipped to the horizon; π where p
/// is inside or on the sphere, which then fills the hemisphere. (Snyder 1996, «Area Light Sources for Real-Time
/// Graphics», §A.)
double sphere_form_factor_times_pi(Vec3 p, Vec3 n, const Sphere& sphere);

/// Irradiance at p with normal n from an emissive surface, its emitting side respected, visibility left out.
/// A point of the light's own surface is in its plane only up to rounding: callers leave out a surface's own light.
Rgb surface_light_irradiance(const SurfaceLight& light, Vec3 p, Vec3 n);

} // namespace duet

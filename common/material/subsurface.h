// Subsurface scattering: light enters a solid such as skin or marble, is scattered inside many times, and leaves it
// elsewhere. This file describes the inside of such a solid, and how light passes its surface. The path tracer follows
// the light in between (raytrace/integrator/random_walk.h).
//
// Inside and outside are joined by diffuse light: what passes the layers on top enters with the distribution of
// Lambert's law, and leaves with it (Chiang, Kutz and Burley 2016, "Practical and Controllable Subsurface Scattering
// for Production Path Tracing"). Where the light is scattered within a short distance, the solid looks like the
// layered material with a diffuse surface of the same albedo.
#pragma once

#include "common/material/layered.h"

#include <cmath>
#include <optional>
#include <span>
#include <string_view>

namespace duet {

/// These are the constants of van de Hulst's formula A = (1 − s)(1 − a·s) / (1 + b·s) with s² = 1 − α.
inline constexpr float kHulstA = 0.139f, kHulstB = 1.17f;

/// Describes the medium inside a solid. It scatters isotropically.
struct SolidInterior {
    Rgb scattering; ///< scattering coefficient σs, 1/m
    Rgb absorption; ///< absorption coefficient σa, 1/m
};
// The layers on top reflect a fraction of the light from inside back. Random walks that follow this reflection would be
// up to five times as long. Instead, the walks ignore it in an interior of the albedo that is seen through the layers.
// They then come as far if their mean free path is longer by free_path_factor() (tested).

/// Returns the interior of which an infinitely thick layer reflects the fraction `albedo` of diffuse light, in [0, 1].
/// mean_free_path is the mean distance between two collisions, in meters, > 0.
SolidInterior solid_interior(Rgb albedo, Rgb mean_free_path);
/// Returns s = √(1 − α), where α is the probability that a collision scatters the light and does not absorb it, for the
/// albedo in [0, 1] of an infinitely thick layer. This is the root of van de Hulst's formula (thick_layer_albedo),
/// computed without cancellation. T is float or a batch of floats.
template <typename T> T similarity_parameter(const T& albedo) {
    using std::sqrt;
    const T b = T(1 + kHulstA) + T(kHulstB) * albedo, c = T(1.0f) - albedo;
    return T(2.0f) * c / (b + sqrt(b * b - T(4 * kHulstA) * c));
}
/// Returns the factor of the mean free path that accounts for reflection at the inner side of the surface, which
/// reflects the fraction internal_reflectance of the light. `albedo` is that of the interior without the surface.
template <typename T> T free_path_factor(const T& albedo, const T& internal_reflectance) {
    return T(1.0f) + albedo * internal_reflectance / (T(1.0f) - internal_reflectance);
}
/// Returns the fraction of diffuse light that an infinitely thick layer reflects, to 0.003. The argument is the
/// probability in [0, 1] that a collision scatters the light and does not absorb it (van de Hulst 1980, "Multiple Light
/// Scattering", vol. 2; the inverse: Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks").
float thick_layer_albedo(float single_scattering_albedo);

/// Holds the measured coefficients of a real solid or liquid.
struct MeasuredSolid {
    std::string_view name;
    Rgb scattering; ///< reduced scattering coefficient σs' = σs·(1 − g), to be used with isotropic scattering, 1/m
    Rgb absorption; ///< absorption coefficient σa, 1/m
    float ior;      ///< index of refraction

    /// Returns the albedo of an infinitely thick layer without a surface.
    Rgb albedo() const;
    /// Returns the mean distance between two collisions, in meters.
    Rgb mean_free_path() const { return Rgb(1.0f) / (scattering + absorption); }
};
/// Returns all measured solids in alphabetical order.
std::span<const MeasuredSolid> measured_solids();
/// Returns the solid of that name, or null for an unknown name.
const MeasuredSolid* find_measured_solid(std::string_view name);

/// A SubsurfaceBsdf is the surface of a solid, seen from outside (wo.z > 0). eval and pdf are those of the reflected
/// light. Light also enters the solid, which only sample finds: its sample is marked as transmitted.
struct SubsurfaceBsdf {
    static constexpr bool kTransmissive = false;

    LayeredBsdf surface; ///< layers that reflect light
    float entering;      ///< fraction of the light below the layers that enters the solid, in [0, 1]
    SolidInterior interior;

    /// Returns the BSDF of the reflected light, without the cosine.
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const { return surface.eval(wo, wi, mode); }
    /// Draws a direction of reflected light, or of light that enters. `lobe` in [0, 1) chooses.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    /// Returns the density, by solid angle, with which sample draws a reflected wi.
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;

private:
    float entering_probability(float cosine) const;
};

/// A SubsurfaceExitBsdf is the surface of a solid at a point where light leaves it. The light that comes from inside is
/// diffuse, so that its direction does not matter: wo is any direction outside, where all light is sent.
struct SubsurfaceExitBsdf {
    static constexpr bool kTransmissive = false;

    LayeredBsdf surface; ///< layers that the light passes
    float mean_passed;   ///< surface.mean_passed()

    /// Returns the fraction of the light from inside that leaves toward wi per solid angle, divided by the cosine of
    /// wi.
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Draws a direction outside, with the density of Lambert's law.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    /// Returns the density, by solid angle, with which sample draws wi.
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
};

} // namespace duet

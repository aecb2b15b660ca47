// This file provides the directional albedo of GGX microfacets, and the energy compensation for multiple scattering
// between them.
#pragma once

#include "common/image/rgb.h"

#include <array>
#include <cstddef>

namespace duet {

/// GgxAlbedo is the directional albedo of single scattering. `energy` is the albedo where every microfacet reflects
/// all light. With Schlick's Fresnel term of reflectance R at normal incidence, the albedo is
/// energy·(R + (1 − R)·schlick_weight). The split-sum approximation tabulates the same two values (Karis 2013, "Real
/// Shading in Unreal Engine 4").
struct GgxAlbedo {
    float energy = 1, schlick_weight = 0;

    Rgb albedo(Rgb f0) const { return (f0 + (Rgb(1.0f) - f0) * schlick_weight) * energy; }
    float albedo(float f0) const { return (f0 + (1 - f0) * schlick_weight) * energy; }
};

// All functions below interpolate in tables that are generated when the project is built (ggx_albedo_main.cpp). alpha
// is in [0, 1]; values below 1e-4 count as 1e-4. cosine is between normal and viewer, in [0, 1]. The error of the
// energy is at most 0.006, and that of energy·schlick_weight at most 0.015 (tested).

/// Returns the directional albedo of single scattering.
GgxAlbedo ggx_albedo(float alpha, float cosine);
/// Returns 1 − energy: the fraction of light that single scattering misses, because it hits a second microfacet.
float ggx_energy_loss(float alpha, float cosine);
/// Returns ggx_energy_loss for each lane of a batch.
template <typename Batch> Batch ggx_energy_loss(Batch alpha, Batch cosine) {
    constexpr std::size_t kLanes = sizeof(Batch) / sizeof(float);
    alignas(Batch) std::array<float, kLanes> alphas, cosines;
    alpha.store_aligned(alphas.data());
    cosine.store_aligned(cosines.data());
    for (std::size_t i = 0; i < kLanes; ++i) cosines[i] = ggx_energy_loss(alphas[i], cosines[i]);
    return Batch::load_aligned(cosines.data());
}
/// GgxAverageAlbedo holds cosine-weighted means over the hemisphere, 2∫ … μ dμ: `energy_loss` of 1 − energy, and
/// `schlick_weight` of energy·schlick_weight.
struct GgxAverageAlbedo {
    float energy_loss = 0, schlick_weight = 0;

    float albedo(float f0) const { return f0 * (1 - energy_loss) + (1 - f0) * schlick_weight; }
};
/// Returns the averages over all directions.
GgxAverageAlbedo ggx_average_albedo(float alpha);

/// Returns the cosine-weighted mean over the hemisphere of Schlick's Fresnel term.
inline Rgb schlick_average(Rgb f0) { return f0 + (Rgb(1.0f) - f0) * (1.0f / 21); }

/// Returns the factor `multiple_scattering` of the lobe multiple_scattering·energy_loss(wo)·energy_loss(wi), which
/// models the light that is reflected by two or more microfacets. The lobe is reciprocal and returns all lost light
/// where nothing is absorbed (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks"; the fraction
/// that survives all reflections: Turquin 2019, "Practical Multiple Scattering Compensation for Microfacet Models", §2,
/// after Hill). average_fresnel is the mean reflectance of a microfacet. The result is black where mean_energy_loss is
/// below 0.4 %.
Rgb ggx_multiple_scattering(Rgb average_fresnel, float mean_energy_loss);

} // namespace duet

// How much of the light that GGX microfacets receive comes back from the first of them, by roughness and angle, and what
// becomes of the rest.
#pragma once

#include "common/image/rgb.h"

namespace duet {

/// Of white light from all around a single reflection returns `energy` to the viewer where every microfacet reflects
/// all; with Schlick's Fresnel term of reflectance R at normal incidence, energy·(R + (1 − R)·share): what the split
/// sum tabulates, too (Karis 2013, «Real Shading in Unreal Engine 4»).
struct GgxAlbedo {
    float energy = 1, share = 0;

    Rgb of(Rgb normal) const { return (normal + (Rgb(1.0f) - normal) * share) * energy; }
    float of(float normal) const { return (normal + (1 - normal) * share) * energy; }
};

// All are looked up in tables that are computed when the project is built (ggx_albedo_main.cpp). alpha in [0, 1], of
// which those below 1e-4 count as that; cosine: between normal and viewer, in [0, 1]. The energy is off by at most
// 0.006, energy·share by 0.015 (tested).

GgxAlbedo ggx_albedo(float alpha, float cosine);
/// 1 − energy: what hits a second microfacet.
float ggx_lost(float alpha, float cosine);
/// The means over the hemisphere, 2∫ … μ dμ, of what is lost, and of energy·share.
struct GgxMeans {
    float lost = 0, share = 0;

    float of(float normal) const { return normal * (1 - lost) + (1 - normal) * share; }
};
GgxMeans ggx_means(float alpha);

/// Schlick's Fresnel term, the mean over the hemisphere.
inline Rgb schlick_average(Rgb normal) { return normal + (Rgb(1.0f) - normal) * (1.0f / 21); }

/// The light that two or more microfacets reflect one after the other leaves by the lobe
/// multiple·lost(wo)·lost(wi), which is reciprocal and returns all that is lost where none is absorbed (Kulla and Conty
/// 2017, «Revisiting Physically Based Shading at Imageworks»; the share that survives all reflections: Turquin 2019,
/// «Practical Multiple Scattering Compensation for Microfacet Models», §2, after Hill): this is `multiple`, from the mean
/// reflectance of a microfacet. Black where less than 0.4 % is lost in the mean.
Rgb ggx_multiple(Rgb average_fresnel, float mean_lost);

} // namespace duet

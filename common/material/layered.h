// Varnish over wood, plastic, lacquered metal: a glossy layer over a diffuse or metallic one, a clear coat over both.
#pragma once

#include "common/image/rgb.h"
#include "common/material/bsdf.h"

namespace duet {

/// One lobe of GGX microfacets with Schlick's Fresnel term, light of further reflections included: MetalBsdf's own.
struct GlossyLayer {
    Rgb normal;     ///< reflectance at normal incidence
    float alpha;    ///< at least LayeredBsdf::kSmoothest
    Rgb multiple;   ///< see ggx_multiple
};

/// From below: a diffuse surface under a dielectric one, mixed with a metal of the same roughness; over these a clear
/// coat. What a layer reflects does not reach the next: the diffuse surface receives and returns through factors
/// 1 − E(w), E the albedo of the layer above at the angle of w, scaled so that white under clear returns all (Kelemen and
/// Szirmay-Kalos 2001, «A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling», §4); what is
/// under the coat is multiplied by 1 − max(E(wo), E(wi)), so that a mirror under it returns all. Reciprocal, on both
/// sides of the surface; no more light leaves than arrives (tested).
struct LayeredBsdf {
    static constexpr float kSmoothest = 1e-3f; ///< alpha: no lobe is a perfect mirror

    Rgb diffuse;         ///< albedo of the diffuse surface, times the part of it in the mix
    GlossyLayer glossy;  ///< both materials of the mix
    float dielectric;    ///< reflectance of the dielectric alone, at normal incidence
    float dielectric_multiple;
    float coat;          ///< how much of the surface it covers, in [0, 1]
    float coat_alpha, coat_multiple;

    static constexpr float kCoatNormal = 0.04f; ///< reflectance of a coat, index of refraction 1.5, at normal incidence

    struct Description {
        Rgb color;            ///< of the diffuse surface, and of the metal at normal incidence
        float metallic = 0;   ///< part of the mix
        float dielectric = 0.04f;
        float roughness = 0;
        float coat = 0, coat_roughness = 0;
    };
    explicit LayeredBsdf(const Description& d);

    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;

    /// What a viewer at an angle sees of each layer: parts of light that comes from everywhere.
    struct Albedos {
        Rgb diffuse, glossy, coat;
    };
    Albedos albedos(float cosine) const;
};

} // namespace duet

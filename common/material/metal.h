// This file defines the metal material: a smooth mirror, or a rough one with GGX microfacets.
#pragma once

#include "common/material/bsdf.h"
#include "common/material/conductor.h"
#include "common/texture/texture.h"

namespace duet {

/// A MetalBsdf reflects by GGX microfacets with Smith's height-correlated masking, sampled by visible normals (Walter
/// et al. 2007; Heitz 2014, 2018). Multiple scattering between microfacets is compensated (ggx_multiple), so that a
/// rough metal that absorbs nothing reflects all light. The Fresnel term is exact for a named conductor, and else
/// Schlick's from the reflectance at normal incidence. Where alpha is below kSmoothAlpha, the metal is a perfect
/// mirror.
struct MetalBsdf {
    static constexpr float kSmoothAlpha = 1e-4f;

    Rgb reflectance; ///< reflectance at normal incidence
    float alpha;     ///< GGX width: roughness²
    Rgb n, k;        ///< complex index of a named conductor, or 0
    Rgb multiple;    ///< factor of the multiple-scattering lobe: see ggx_multiple

    MetalBsdf(Rgb reflectance, float alpha);
    MetalBsdf(const Conductor& conductor, float alpha);

    bool smooth() const { return alpha < kSmoothAlpha; }
    Rgb fresnel(float cosine) const;
    /// Returns the directional albedo: the fraction of uniform incident light that is reflected to a viewer at that
    /// angle. A rough named conductor uses Schlick's term here.
    Rgb albedo(float cosine) const;
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Draws wi. `lobe` in [0, 1) chooses between one reflection and several.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
};

struct Metal {
    RgbSlot reflectance{Rgb(0.9f)}; ///< value at normal incidence, each channel in [0, 1]
    ScalarSlot roughness{0};        ///< perceptual, in [0, 1]; GGX alpha = roughness²
    Conductor conductor{};          ///< replaces the reflectance where it exists

    MetalBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet

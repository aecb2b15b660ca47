// Metal: a mirror, smooth or roughened by microfacets.
#pragma once

#include "common/material/bsdf.h"
#include "common/material/conductor.h"
#include "common/texture/texture.h"

namespace duet {

/// GGX microfacets with Smith's height-correlated masking, visible normals sampled (Walter et al. 2007; Heitz 2014,
/// 2018), and light of further reflections among them (ggx_multiple), so that a rough metal that absorbs nothing
/// returns all. Fresnel's term is exact for a named conductor, else Schlick's from the reflectance at normal incidence.
/// At roughness below kSmooth: a perfect mirror.
struct MetalBsdf {
    static constexpr float kSmoothAlpha = 1e-4f;

    Rgb reflectance; ///< at normal incidence
    float alpha;     ///< GGX width: roughness²
    Rgb n, k;        ///< of a named conductor, or 0
    Rgb multiple;    ///< of further reflections: see ggx_multiple

    MetalBsdf(Rgb reflectance, float alpha);
    MetalBsdf(const Conductor& conductor, float alpha);

    bool smooth() const { return alpha < kSmoothAlpha; }
    Rgb fresnel(float cosine) const;
    /// What comes back of white light from everywhere; of a named conductor by Schlick's term.
    Rgb albedo(float cosine) const;
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// `lobe` chooses between one reflection and several.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
};

struct Metal {
    RgbSlot reflectance{Rgb(0.9f)}; ///< at normal incidence, each channel in [0, 1]
    ScalarSlot roughness{0};        ///< perceptual, in [0, 1]; GGX alpha = roughness²
    Conductor conductor{};          ///< where it exists: in place of the reflectance

    MetalBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet

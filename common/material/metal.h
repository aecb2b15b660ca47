// Metal: a mirror, smooth or roughened by microfacets.
#pragma once

#include "common/material/bsdf.h"
#include "common/texture/texture.h"

namespace duet {

/// GGX microfacets with Smith's height-correlated masking, visible normals sampled (Walter et al. 2007; Heitz 2014,
/// 2018), and Schlick's Fresnel term from the reflectance at normal incidence. At roughness below kSmooth: a perfect
/// mirror.
struct MetalBsdf {
    static constexpr float kSmoothAlpha = 1e-4f;

    Rgb reflectance; ///< at normal incidence
    float alpha;     ///< GGX width: roughness²

    bool smooth() const { return alpha < kSmoothAlpha; }
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
};

struct Metal {
    RgbSlot reflectance{Rgb(0.9f)}; ///< at normal incidence, each channel in [0, 1]
    ScalarSlot roughness{0};        ///< perceptual, in [0, 1]; GGX alpha = roughness²

    MetalBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet

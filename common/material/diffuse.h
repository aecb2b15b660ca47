// This file defines the diffuse material and Lambert's reflection, which acts on both sides of the surface.
#pragma once

#include "common/material/bsdf.h"
#include "common/material/rough_diffuse.h"
#include "common/sampling/warp.h"
#include "common/texture/texture.h"

namespace duet {

/// Reflects the fraction `albedo` of the light, equally in all directions of the side it came from.
struct DiffuseBsdf {
    Rgb albedo;

    /// Returns albedo / π where wo and wi are on the same side, and black elsewhere.
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode) const { return same_hemisphere(wo, wi) ? albedo * kInvPi : Rgb(); }
    /// Draws wi cosine-distributed on wo's side. The sample is empty only where wo.z is 0.
    std::optional<BsdfSample> sample(Vec3 wo, float, Vec2 u, TransportMode) const {
        if (wo.z == 0) return std::nullopt;
        Vec3 wi = cosine_hemisphere(u);
        const float density = cosine_hemisphere_pdf(wi.z);
        if (wo.z < 0) wi.z = -wi.z;
        return BsdfSample{wi, albedo, density}; // weight: (albedo / π)·cos / (cos / π)
    }
    float pdf(Vec3 wo, Vec3 wi, TransportMode) const {
        return same_hemisphere(wo, wi) ? cosine_hemisphere_pdf(abs_cos_theta(wi)) : 0.0f;
    }
};

struct Diffuse {
    RgbSlot albedo{Rgb(0.8f)}; ///< each channel in [0, 1]
    ScalarSlot roughness{0};   ///< in [0, 1]; a value above 0 selects RoughDiffuseBsdf

    bool rough() const { return !roughness.constant() || roughness.value > 0; }

    DiffuseBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    RoughDiffuseBsdf rough_at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet

// This file defines the diffuse material and Lambert's reflection, which acts on both sides of the surface.
#pragma once

#include "common/material/bsdf.h"
#include "common/material/rough_diffuse.h"
#include "common/sampling/warp.h"
#include "common/texture/texture.h"

namespace duet {

/// Reflects the fraction `albedo` of the light, equally in all directions of the side it came from.
template <typename T> struct DiffuseBsdfT {
    static constexpr bool kTransmissive = false;

    RgbT<T> albedo;

    /// Returns albedo / π where wo and wi are on the same side, and black elsewhere.
    RgbT<T> eval(Vec3T<T> wo, Vec3T<T> wi, TransportMode) const {
        return select(same_hemisphere(wo, wi), albedo * T(kInvPi), RgbT<T>(T(0)));
    }
    /// Draws wi cosine-distributed on wo's side. The sample is empty only where wo.z is 0.
    OptionalBsdfSample<T> sample(Vec3T<T> wo, T, Vec2T<T> u, TransportMode) const {
        Vec3T<T> wi = cosine_hemisphere(u);
        const T density = cosine_hemisphere_pdf(wi.z);
        wi.z = select(wo.z < T(0), -wi.z, wi.z);
        return sample_where(wo.z != T(0), BsdfSampleT<T>{wi, albedo, density}); // weight: (albedo/π)·cos / (cos/π)
    }
    T pdf(Vec3T<T> wo, Vec3T<T> wi, TransportMode) const {
        return select(same_hemisphere(wo, wi), cosine_hemisphere_pdf(abs_cos_theta(wi)), T(0));
    }
};
using DiffuseBsdf = DiffuseBsdfT<float>;

/// Describes a matte surface; where it is rough, it looks like clay or plaster.
struct Diffuse {
    RgbSlot albedo{Rgb(0.8f)}; ///< each channel in [0, 1]
    ScalarSlot roughness{0};   ///< in [0, 1]; a value above 0 selects RoughDiffuseBsdf

    bool rough() const { return !roughness.constant() || roughness.value > 0; }

    /// Returns Lambert's BSDF at a point.
    DiffuseBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    /// Returns the rough BSDF at a point.
    RoughDiffuseBsdf rough_at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet

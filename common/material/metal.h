// This file defines the metal material: a smooth mirror, or a rough one with GGX microfacets.
#pragma once

#include "common/material/bsdf.h"
#include "common/material/conductor.h"
#include "common/material/ggx.h"
#include "common/material/ggx_albedo.h"
#include "common/material/microfacet.h"
#include "common/texture/texture.h"

namespace duet {

/// A MetalBsdf reflects by GGX microfacets with Smith's height-correlated masking, sampled by visible normals (Walter
/// et al. 2007; Heitz 2014, 2018). Multiple scattering between microfacets is compensated (ggx_multiple_scattering), so
/// that a rough metal that absorbs nothing reflects all light. The Fresnel term is exact for a named conductor, and
/// else Schlick's from the reflectance at normal incidence. Where alpha is below kSmoothAlpha, the metal is a perfect
/// mirror.
template <typename T> struct MetalBsdfT {
    static constexpr bool kTransmissive = false;
    static constexpr float kSmoothAlpha = 1e-4f;

    RgbT<T> reflectance; ///< reflectance at normal incidence
    T alpha;             ///< GGX width: roughness²
    RgbT<T> n, k;        ///< complex index of a named conductor, or 0
    RgbT<T> multiple_scattering; ///< factor of the multiple-scattering lobe: see ggx_multiple_scattering

    MetalBsdfT(Rgb reflectance, float alpha);
    MetalBsdfT(const Conductor& conductor, float alpha);
    MetalBsdfT(RgbT<T> reflectance_, T alpha_, RgbT<T> n_, RgbT<T> k_, RgbT<T> multiple_)
        : reflectance(reflectance_), alpha(alpha_), n(n_), k(k_), multiple_scattering(multiple_) {}

    bool smooth() const { return all(alpha < T(kSmoothAlpha)); }
    /// Returns the reflectance of a microfacet. The cosine is that between its normal and wo.
    RgbT<T> fresnel(T cosine) const;
    /// Returns the directional albedo: the fraction of uniform incident light that is reflected to a viewer at that
    /// angle. A rough named conductor uses Schlick's term here.
    RgbT<T> directional_albedo(T cosine) const;
    /// Returns the BSDF without the cosine; black for a smooth metal, and where wo and wi are on different sides.
    RgbT<T> eval(Vec3T<T> wo, Vec3T<T> wi, TransportMode mode) const;
    /// Draws wi. `lobe` in [0, 1) chooses between one reflection and several.
    OptionalBsdfSample<T> sample(Vec3T<T> wo, T lobe, Vec2T<T> u, TransportMode mode) const;
    /// Returns the density, by solid angle, with which sample draws wi; 0 for a smooth metal.
    T pdf(Vec3T<T> wo, Vec3T<T> wi, TransportMode mode) const;

private:
    /// Returns the fraction of light that single scattering misses, or 0 without the multiple-scattering lobe.
    T energy_loss(T cosine) const;
    // These are eval and pdf for wo and wi above the surface, with their microfacet and energy_loss(wo.z).
    RgbT<T> eval_above(Vec3T<T> wo, Vec3T<T> wi, const MicrofacetT<T>& h, T lost_at_wo) const;
    T pdf_above(Vec3T<T> wo, Vec3T<T> wi, const MicrofacetT<T>& h, T lost_at_wo) const;
};
using MetalBsdf = MetalBsdfT<float>;

template <typename T> RgbT<T> MetalBsdfT<T>::fresnel(T cosine) const {
    const MaskOf<T> named = n.r != T(0);
    if (none_of(named)) return fresnel_schlick(reflectance, cosine);
    const RgbT<T> exact{fresnel_conductor(cosine, n.r, k.r), fresnel_conductor(cosine, n.g, k.g),
                        fresnel_conductor(cosine, n.b, k.b)};
    return select(named, exact, fresnel_schlick(reflectance, cosine));
}

template <typename T> RgbT<T> MetalBsdfT<T>::eval(Vec3T<T> wo, Vec3T<T> wi, TransportMode) const {
    const MaskOf<T> reflected = same_hemisphere(wo, wi);
    if (smooth() || none_of(reflected)) return RgbT<T>(T(0));
    wo = to_upper_hemisphere(wo);
    wi = to_upper_hemisphere(wi);
    return select(reflected, eval_above(wo, wi, microfacet(wo, wi), energy_loss(wo.z)), RgbT<T>(T(0)));
}

template <typename T> T MetalBsdfT<T>::pdf(Vec3T<T> wo, Vec3T<T> wi, TransportMode) const {
    const MaskOf<T> reflected = same_hemisphere(wo, wi);
    if (smooth() || none_of(reflected)) return T(0);
    wo = to_upper_hemisphere(wo);
    wi = to_upper_hemisphere(wi);
    return select(reflected, pdf_above(wo, wi, microfacet(wo, wi), energy_loss(wo.z)), T(0));
}

template <typename T>
OptionalBsdfSample<T> MetalBsdfT<T>::sample(Vec3T<T> wo, T lobe, Vec2T<T> u, TransportMode) const {
    const MaskOf<T> visible = wo.z != T(0);
    if (smooth()) return sample_where(visible, BsdfSampleT<T>{mirrored(wo), fresnel(abs_cos_theta(wo)), T(1), true});

    const Vec3T<T> above = to_upper_hemisphere(wo);
    const T lost_at_wo = energy_loss(above.z);
    const MaskOf<T> several = lobe >= T(1) - lost_at_wo;
    Vec3T<T> wi = normalize(reflect(above, ggx_sample_visible_normal(above, alpha, u)));
    if (any(several)) wi = select(several, cosine_hemisphere(u), wi);
    // A visible normal may reflect wo below the surface, where the light would hit a second microfacet. Such samples
    // are dropped, so the density integrates to slightly less than 1.
    const MaskOf<T> valid = visible & (wi.z > T(0));
    const MicrofacetT<T> h = microfacet(above, wi);
    const T density = pdf_above(above, wi, h, lost_at_wo);
    const RgbT<T> weight = eval_above(above, wi, h, lost_at_wo) * (wi.z / density);
    wi.z = select(wo.z < T(0), -wi.z, wi.z);
    return sample_where(valid, BsdfSampleT<T>{wi, weight, density});
}

template <typename T> T MetalBsdfT<T>::energy_loss(T cosine) const {
    const MaskOf<T> single = is_black(multiple_scattering);
    return all(single) ? T(0) : select(single, T(0), ggx_energy_loss(alpha, cosine));
}

template <typename T>
RgbT<T> MetalBsdfT<T>::eval_above(Vec3T<T> wo, Vec3T<T> wi, const MicrofacetT<T>& h, T lost_at_wo) const {
    return fresnel(h.cosine) * ggx_reflection(wo, wi, h.normal, alpha) +
           multiple_scattering * (lost_at_wo * energy_loss(wi.z));
}

template <typename T>
T MetalBsdfT<T>::pdf_above(Vec3T<T> wo, Vec3T<T> wi, const MicrofacetT<T>& h, T lost_at_wo) const {
    return ggx_reflections_pdf(wo, wi, h.normal, alpha, lost_at_wo);
}
extern template struct MetalBsdfT<float>; // in metal.cpp

/// Describes a metal by its reflectance at normal incidence, or by the complex index of a named conductor.
struct Metal {
    RgbSlot reflectance{Rgb(0.9f)}; ///< value at normal incidence, each channel in [0, 1]
    ScalarSlot roughness{0};        ///< perceptual, in [0, 1]; GGX alpha = roughness²
    Conductor conductor{};          ///< replaces the reflectance where it exists

    /// Returns the BSDF at a point.
    MetalBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet

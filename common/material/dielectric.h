// This file defines the dielectric material (glass, water) and its smooth BSDF.
#pragma once

#include "common/material/bsdf.h"
#include "common/material/microfacet.h"
#include "common/material/rough_dielectric.h"
#include "common/material/thin_dielectric.h"
#include "common/texture/texture.h"

#include <cmath>

namespace duet {

/// Reflects and refracts specularly by Fresnel's equations and Snell's law. +z points to the outside.
template <typename T> struct DielectricBsdfT {
    static constexpr bool kTransmissive = true;

    T eta;        ///< index of refraction inside over outside
    RgbT<T> tint; ///< factor of transmitted light at each crossing

    RgbT<T> eval(Vec3T<T>, Vec3T<T>, TransportMode) const { return RgbT<T>(T(0)); }
    /// Chooses reflection (lobe < F) or refraction. At total reflection it always reflects. The sample is empty where
    /// wo.z is 0.
    OptionalBsdfSample<T> sample(Vec3T<T> wo, T lobe, Vec2T<T> u, TransportMode mode) const;
    T pdf(Vec3T<T>, Vec3T<T>, TransportMode) const { return T(0); }
};
using DielectricBsdf = DielectricBsdfT<float>;

template <typename T>
OptionalBsdfSample<T> DielectricBsdfT<T>::sample(Vec3T<T> wo, T lobe, Vec2T<T>, TransportMode mode) const {
    const T zero(0), one(1), cos_o = abs_cos_theta(wo);
    const T relative = select(wo.z > zero, eta, one / eta); // index beyond the boundary over the index on wo's side
    const T reflected = fresnel_dielectric(cos_o, relative); // 1 at total reflection
    const MaskOf<T> reflects = lobe < reflected;
    const T cos_t = safe_sqrt(cos2_refracted(cos_o, relative));
    // L / n² is constant along a refracted ray: radiance that enters the thinner medium spreads over a larger solid
    // angle.
    const T spread = mode == TransportMode::kRadiance ? one / (relative * relative) : one;
    return sample_where((wo.z != zero) & (reflects | (cos_t != zero)),
                        BsdfSampleT<T>{select(reflects, mirrored(wo), refract(wo, cos_t, relative)),
                                       select(reflects, RgbT<T>(one), tint * spread),
                                       select(reflects, reflected, one - reflected), true, !reflects});
}
extern template struct DielectricBsdfT<float>; // in dielectric.cpp

/// Returns whether a boundary of this relative index bends light so little that its microfacets do not matter. They
/// would be computed from the difference of two nearly equal directions, so such boundaries are treated as smooth.
inline bool is_index_matched(float eta) { return std::abs(eta - 1) <= 1e-3f; }

/// Describes clear or tinted glass and liquids: smooth, rough or as a thin sheet.
struct Dielectric {
    float ior = 1.5f; ///< index of refraction inside over outside, in [1, 4]
    RgbSlot tint{Rgb(1.0f)};
    ScalarSlot roughness{0};     ///< perceptual; GGX alpha = roughness²; smooth where alpha is below kSmoothAlpha
    bool thin = false;           ///< a thin sheet, ThinDielectricBsdf, which is always smooth
    Rgb absorption{0.0f};        ///< absorption coefficient of the interior, 1/m (Beer-Lambert law)
    /// Where dielectrics overlap, the one of the highest priority determines the medium. With priority 0 the
    /// dielectric ignores overlaps and always refracts as if it were surrounded by the outside.
    int priority = 0;

    static constexpr float kSmoothAlpha = 1e-4f;

    bool smooth() const { return roughness.constant() && sqr(roughness.value) < kSmoothAlpha; }
    bool has_interior_medium() const { return !thin && (!is_black(absorption) || priority > 0); }
    /// Returns the smooth BSDF at a point. bsdf_at calls this function or one of the next two, as the material needs.
    DielectricBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    /// Returns the BSDF of a thin sheet at a point.
    ThinDielectricBsdf thin_at(const TextureSet& textures, const SurfacePoint& point) const;
    /// Returns the rough BSDF at a point.
    RoughDielectricBsdf rough_at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet

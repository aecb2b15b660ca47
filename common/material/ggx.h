// The GGX (Trowbridge-Reitz) distribution of microfacets with Smith's masking (Walter et al. 2007; Heitz 2014,
// «Understanding the Masking-Shadowing Function»). Directions are unit, in the local frame, with z ≥ 0; alpha in (0,
// 1].
//
// Written without 1 − cos²: sin² is x² + y², which keeps its digits near the pole where narrow lobes live, and no
// tangent: nothing divides by a cosine that may be tiny.
#pragma once

#include "common/sampling/warp_batch.h"
#include "common/system/sabotage.h"
#include "common/vec/vec.h"

#include <cmath>

namespace duet {

template <typename T> T sin2_theta(Vec3T<T> w) { return w.x * w.x + w.y * w.y; }

/// Density of microfacet normals h by solid angle: ∫ D(h) cos θ_h dh = 1 over the hemisphere (Walter et al., eq. 33).
template <typename T> T ggx_d(Vec3T<T> h, T alpha) {
    // (cos² (α² − 1) + 1) = sin² + α² cos²; divided by α once more so that its square neither overflows nor vanishes.
    const T a = sin2_theta(h) / alpha + alpha * h.z * h.z;
    using Number = std::conditional_t<std::is_same_v<T, double>, double, float>;
    return T(static_cast<Number>(1.0 / kPiDouble)) / (a * a);
}

/// √(cos² + α² sin²) = cos·(1 + 2Λ), with Smith's Λ (Heitz 2014, eq. 72).
template <typename T> T ggx_projected(Vec3T<T> w, T alpha) { return sqrt(w.z * w.z + alpha * alpha * sin2_theta(w)); }

/// Smith's Λ(w): masked over visible microfacet area. Infinite for z = 0.
template <typename T> T ggx_lambda(Vec3T<T> w, T alpha) {
    // ½(√(1 + α² tan²) − 1), its difference rationalised.
    const T alpha2_sin2 = alpha * alpha * sin2_theta(w);
    return alpha2_sin2 / (T(2) * w.z * (w.z + ggx_projected(w, alpha)));
}

/// The part of microfacets that is visible from w: 1/(1 + Λ), in [0, 1].
template <typename T> T ggx_g1(Vec3T<T> w, T alpha) { return T(2) * w.z / (w.z + ggx_projected(w, alpha)); }

/// G₂(wo, wi) / (4 cos θₒ cos θᵢ), where G₂ = 1/(1 + Λₒ + Λᵢ) accounts for the correlation of heights (Heitz 2014, eq.
/// 99).
template <typename T> T ggx_visibility(Vec3T<T> wo, Vec3T<T> wi, T alpha) {
    return T(0.5f) / (wi.z * ggx_projected(wo, alpha) + wo.z * ggx_projected(wi, alpha));
}

/// What microfacets that reflect all send from wi to wo, h the normal of those between: D G₂ / (4 cos θₒ cos θᵢ) (Walter et
/// al., eq. 20, but for Fresnel's term).
template <typename T> T ggx_reflection(Vec3T<T> wo, Vec3T<T> wi, Vec3T<T> h, T alpha) {
    return ggx_d(h, alpha) * ggx_visibility(wo, wi, alpha);
}

/// G₂(wo, wi) / G₁(wo): what is left of the weight of a sample of visible normals, in [0, 1].
template <typename T> T ggx_g2_over_g1(Vec3T<T> wo, Vec3T<T> wi, T alpha) {
    const T so = ggx_projected(wo, alpha), si = ggx_projected(wi, alpha);
    return wi.z * (wo.z + so) / (wi.z * so + wo.z * si);
}

/// Density, by solid angle of wi, of wi = reflect(wo, h) with h a visible normal: G₁ D / (4 cos θₒ) (Heitz 2018, §5).
template <typename T> T ggx_reflection_pdf(Vec3T<T> wo, Vec3T<T> h, T alpha) {
    return ggx_d(h, alpha) / (T(2) * (wo.z + ggx_projected(wo, alpha)));
}

/// The density of wi where the part `several` of the light leaves after several reflections, by the cosine (ggx_multiple in
/// ggx_albedo.h), and the rest after one at h.
template <typename T> T ggx_reflections_pdf(Vec3T<T> wo, Vec3T<T> wi, Vec3T<T> h, T alpha, T several) {
    return lerp(ggx_reflection_pdf(wo, h, alpha), cosine_hemisphere_pdf(wi.z), several);
}

/// A microfacet normal with density G₁(wo) max(0, wo·h) D(h) / cos θₒ: stretched to the hemisphere, visible normals are
/// the halfway vectors of a uniform spherical cap (Dupuy and Benyoub 2023, «Sampling Visible GGX Normals with
/// Spherical Caps», listing 3). u in [0, 1)². The result has z > 0, also for grazing wo.
template <typename T> Vec3T<T> ggx_sample_visible_normal(Vec3T<T> wo, T alpha, Vec2T<T> u) {
    const Vec3T<T> w = normalize(Vec3T<T>(alpha * wo.x, alpha * wo.y, wo.z));
    // A point c of the cap, c.z = 1 − gap in (−w.z, 1]. c.z + w.z is written out: as a sum it would cancel at grazing
    // wo.
    const T gap = u.y * (T(1) + w.z);
    const T r = safe_sqrt(gap * (T(2) - gap));
    const Vec2T<T> circle = unit_circle(u.x);
    const T z = sabotaged(Guard::kVisibleNormals) ? T(1) - u.y : (T(1) - u.y) * (T(1) + w.z);
    return normalize(Vec3T<T>(alpha * (r * circle.x + w.x), alpha * (r * circle.y + w.y), z));
}

} // namespace duet

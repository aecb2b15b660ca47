// This file implements the GGX (Trowbridge-Reitz) distribution of microfacets with Smith's masking (Walter et al.
// 2007; Heitz 2014, "Understanding the Masking-Shadowing Function"). All directions are unit vectors in the local
// frame with z ≥ 0, and alpha is in (0, 1].
//
// The formulas avoid 1 − cos²: they compute sin² as x² + y², which is precise near the pole, where narrow lobes
// lie. They also avoid the tangent, so nothing is divided by a cosine that may be tiny.
#pragma once

#include "common/sampling/warp_batch.h"
#include "common/vec/vec.h"

#include <cmath>

namespace duet {

/// Returns the squared sine of the angle between the normal and w.
template <typename T> T sin2_theta(Vec3T<T> w) { return w.x * w.x + w.y * w.y; }

/// Returns D(h), the density of microfacet normals by solid angle: ∫ D(h) cos θ_h dh = 1 over the hemisphere (Walter
/// et al., eq. 33).
template <typename T> T ggx_d(Vec3T<T> h, T alpha) {
    // The denominator of eq. 33 is cos² (α² − 1) + 1 = sin² + α² cos². It is divided by α once more so that its
    // square neither overflows nor underflows.
    const T a = sin2_theta(h) / alpha + alpha * h.z * h.z;
    using Number = std::conditional_t<std::is_same_v<T, double>, double, float>;
    return T(static_cast<Number>(1.0 / kPiDouble)) / (a * a);
}

/// Returns √(cos² + α² sin²) = cos·(1 + 2Λ) with Smith's Λ (Heitz 2014, eq. 72).
template <typename T> T ggx_projected(Vec3T<T> w, T alpha) { return sqrt(w.z * w.z + alpha * alpha * sin2_theta(w)); }

/// Returns Smith's Λ(w), the ratio of masked to visible microfacet area. It is infinite for z = 0.
template <typename T> T ggx_lambda(Vec3T<T> w, T alpha) {
    // This is ½(√(1 + α² tan²) − 1) with its difference rationalized, which avoids cancellation.
    const T alpha2_sin2 = alpha * alpha * sin2_theta(w);
    return alpha2_sin2 / (T(2) * w.z * (w.z + ggx_projected(w, alpha)));
}

/// Returns the fraction of microfacets visible from w: G₁ = 1/(1 + Λ), in [0, 1].
template <typename T> T ggx_g1(Vec3T<T> w, T alpha) { return T(2) * w.z / (w.z + ggx_projected(w, alpha)); }

/// Returns G₂(wo, wi) / (4 cos θₒ cos θᵢ), where G₂ = 1/(1 + Λₒ + Λᵢ) accounts for the correlation of
/// heights (Heitz 2014, eq. 99).
template <typename T> T ggx_visibility(Vec3T<T> wo, Vec3T<T> wi, T alpha) {
    return T(0.5f) / (wi.z * ggx_projected(wo, alpha) + wo.z * ggx_projected(wi, alpha));
}

/// Returns the BSDF of perfectly reflecting microfacets: D G₂ / (4 cos θₒ cos θᵢ) (Walter et al., eq. 20,
/// without the Fresnel term). h is the half vector of wo and wi.
template <typename T> T ggx_reflection(Vec3T<T> wo, Vec3T<T> wi, Vec3T<T> h, T alpha) {
    return ggx_d(h, alpha) * ggx_visibility(wo, wi, alpha);
}

/// Returns G₂(wo, wi) / G₁(wo), in [0, 1]: the weight, without the Fresnel term, of a wi drawn from the visible
/// normals.
template <typename T> T ggx_g2_over_g1(Vec3T<T> wo, Vec3T<T> wi, T alpha) {
    const T so = ggx_projected(wo, alpha), si = ggx_projected(wi, alpha);
    return wi.z * (wo.z + so) / (wi.z * so + wo.z * si);
}

/// Returns the density by solid angle of wi = reflect(wo, h), where h is drawn from the visible normals: G₁ D / (4
/// cos θₒ) (Heitz 2018, §5).
template <typename T> T ggx_reflection_pdf(Vec3T<T> wo, Vec3T<T> h, T alpha) {
    return ggx_d(h, alpha) / (T(2) * (wo.z + ggx_projected(wo, alpha)));
}

/// Returns the density of wi for a mixture of two lobes. With probability `p_multiple` wi is cosine-distributed, which
/// samples the light of multiple reflections (ggx_multiple_scattering in ggx_albedo.h). Otherwise wi results from one
/// reflection at h.
template <typename T> T ggx_reflections_pdf(Vec3T<T> wo, Vec3T<T> wi, Vec3T<T> h, T alpha, T p_multiple) {
    return lerp(ggx_reflection_pdf(wo, h, alpha), cosine_hemisphere_pdf(wi.z), p_multiple);
}

/// Draws a visible microfacet normal, of density G₁(wo) max(0, wo·h) D(h) / cos θₒ. After stretching to the
/// hemisphere, visible normals are the half vectors of a uniform spherical cap (Dupuy and Benyoub 2023, "Sampling
/// Visible GGX Normals with Spherical Caps", listing 3). u is in [0, 1)². The result has z > 0, also for grazing wo.
template <typename T> Vec3T<T> ggx_sample_visible_normal(Vec3T<T> wo, T alpha, Vec2T<T> u) {
    const Vec3T<T> w = normalize(Vec3T<T>(alpha * wo.x, alpha * wo.y, wo.z));
    // c is a point of the cap with c.z = 1 − gap in (−w.z, 1]. The sum c.z + w.z is expanded, because it would
    // cancel for grazing wo.
    const T gap = u.y * (T(1) + w.z);
    const T r = safe_sqrt(gap * (T(2) - gap));
    const Vec2T<T> circle = unit_circle(u.x);
    const T z = (T(1) - u.y) * (T(1) + w.z);
    return normalize(Vec3T<T>(alpha * (r * circle.x + w.x), alpha * (r * circle.y + w.y), z));
}

} // namespace duet

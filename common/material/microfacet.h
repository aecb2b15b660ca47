// This file holds the geometry shared by reflection and refraction at microfacets.
#pragma once

#include "common/material/fresnel.h"
#include "common/vec/vec.h"

namespace duet {

/// Mirrors w to the upper hemisphere. Both sides of an opaque surface scatter alike, so the formulas only treat
/// z ≥ 0.
template <typename T> Vec3T<T> to_upper_hemisphere(Vec3T<T> w) { return {w.x, w.y, abs(w.z)}; }

/// MicrofacetT is the microfacet that reflects wo into wi. Both directions lie strictly above the surface, so their
/// sum has z > 0.
template <typename T> struct MicrofacetT {
    Vec3T<T> normal;
    /// The cosine wo·h = wi·h is computed as |wo + wi|/2, because the two dot products differ where rounding leaves
    /// wo and wi with unequal lengths.
    T cosine;
};
using Microfacet = MicrofacetT<float>;
/// Returns the microfacet that reflects wo to wi.
template <typename T> MicrofacetT<T> microfacet(Vec3T<T> wo, Vec3T<T> wi) {
    const Vec3T<T> sum = wo + wi;
    const T size = length(sum);
    return {sum / size, T(0.5f) * size};
}

/// Returns the refraction of wo at a smooth boundary. cos_t > 0 is the cosine of the refracted direction. `relative`
/// is the index beyond the boundary over the index on wo's side. By Snell's law the tangential component is divided
/// by `relative`.
template <typename T> Vec3T<T> refract(Vec3T<T> wo, T cos_t, T relative) {
    return normalize(Vec3T<T>(-wo.x / relative, -wo.y / relative, select(wo.z > T(0), -cos_t, cos_t)));
}
/// Returns the refraction of wo at a microfacet of normal h. cos_o = wo·h > 0, and `relative` is the index beyond
/// the boundary over the index on wo's side. The result is not valid at total reflection.
inline Vec3 refract(Vec3 wo, Vec3 h, float cos_o, float relative) {
    return normalize((h * cos_o - wo) / relative - h * safe_sqrt(cos2_refracted(cos_o, relative)));
}

} // namespace duet

// What reflections and refractions by microfacets have in common.
#pragma once

#include "common/material/fresnel.h"
#include "common/vec/vec.h"

namespace duet {

/// Both sides of an opaque surface are alike: the formulas see them from above.
template <typename T> Vec3T<T> upwards(Vec3T<T> w) { return {w.x, w.y, abs(w.z)}; }

/// The microfacet that reflects wo into wi. Both lie strictly above the surface, so their sum has z > 0.
template <typename T> struct MicrofacetT {
    Vec3T<T> normal;
    /// wo·h = wi·h = |wo + wi|/2: the dot products differ where rounding left wo and wi of unequal length.
    T cosine;
};
using Microfacet = MicrofacetT<float>;
template <typename T> MicrofacetT<T> microfacet(Vec3T<T> wo, Vec3T<T> wi) {
    const Vec3T<T> sum = wo + wi;
    const T size = length(sum);
    return {sum / size, T(0.5f) * size};
}

/// Where a smooth boundary sends what comes from wo, refracted, cos_t > 0 the cosine there: by Snell's law the tangential part
/// shrinks by `relative`, the index beyond the boundary over that on wo's side.
template <typename T> Vec3T<T> refract(Vec3T<T> wo, T cos_t, T relative) {
    return normalize(Vec3T<T>(-wo.x / relative, -wo.y / relative, select(wo.z > T(0), -cos_t, cos_t)));
}
/// Where a microfacet h sends what comes from wo, refracted; cos_o = wo·h > 0, `relative` the index beyond over that on wo's
/// side. Not where it reflects all.
inline Vec3 refract(Vec3 wo, Vec3 h, float cos_o, float relative) {
    return normalize((h * cos_o - wo) / relative - h * safe_sqrt(cos2_refracted(cos_o, relative)));
}

} // namespace duet

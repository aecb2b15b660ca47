// This file holds the types and helpers that all BSDFs share.
//
// All BSDFs follow these conventions, and tests check each of them. wo (to the viewer) and wi (to the light) are unit
// vectors in the local shading frame, where the normal is n = +z. Both point away from the surface. eval returns the
// BSDF without the cosine factor. sample returns weight = f·|cos θᵢ| / pdf, where pdf is the density of wi by
// solid angle. For a specular lobe (a delta distribution) eval and pdf return 0, and only sample finds the lobe.
#pragma once

#include "common/image/rgb.h"

#include <cmath>
#include <optional>

namespace duet {

/// TransportMode is the quantity that a path from wo transports: radiance to the camera, or importance to a light.
/// Refraction scales radiance by η² and leaves importance unchanged (Veach 1997, §5.2).
enum class TransportMode { kRadiance, kImportance };

struct BsdfSample {
    Vec3 wi;
    Rgb weight;            ///< f·|cos θᵢ| / pdf
    float pdf = 0;         ///< density by solid angle; for a specular lobe, the probability of choosing it
    bool specular = false; ///< whether the lobe is a delta distribution, which light sampling cannot find
    bool transmitted = false;
};

inline float cos_theta(Vec3 w) { return w.z; }
inline float abs_cos_theta(Vec3 w) { return abs(w.z); }
inline bool same_hemisphere(Vec3 a, Vec3 b) { return a.z * b.z > 0; }

/// Builds the sample record for a direction wi that a Bsdf without delta lobes has drawn. Density and weight are
/// evaluated for the wi that was rounded to float.
template <typename BsdfType> BsdfSample sample_of(const BsdfType& bsdf, Vec3 wo, Vec3 wi, TransportMode mode) {
    const float density = bsdf.pdf(wo, wi, mode);
    return {wi, bsdf.eval(wo, wi, mode) * (abs_cos_theta(wi) / density), density};
}

/// Returns wo, the viewer's direction in the shading frame, moved to the side of the shading normal that the viewer
/// sees. Near a silhouette an interpolated normal may face away from a viewer who sees the surface, and the material
/// would then show its other side as a dark rim. Such a wo keeps its azimuth, but its |cos θ| becomes 1e-4. `side` is
/// the sign of the cosine between the geometric normal and the direction to the viewer.
template <typename T> Vec3T<T> lifted_above_horizon(Vec3T<T> wo, T side) {
    constexpr float kLowest = 1e-4f;
    const auto seen = wo.z * side >= T(kLowest);
    if constexpr (Arithmetic<T>)
        if (seen) return wo; // almost every call returns here
    const T zero(0.0f), flat = sqrt(wo.x * wo.x + wo.y * wo.y), scale = T(std::sqrt(1 - kLowest * kLowest)) / flat;
    const Vec3T<T> along = select(flat == zero, Vec3T<T>(zero, zero, side),
                                  Vec3T<T>(wo.x * scale, wo.y * scale, T(kLowest) * side));
    return select(seen, wo, along);
}

} // namespace duet

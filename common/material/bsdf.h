// What every material's scattering function has in common, and the closed set of them.
//
// Conventions, tested for each material: wo (to the viewer) and wi (to the light) are unit vectors in the local shading
// frame, n = +z, both pointing away from the surface. eval is the BSDF without the cosine. sample returns
// weight = f·|cos θᵢ| / pdf. pdf is by solid angle of wi; for a specular lobe (a delta distribution) eval and pdf are 0
// and only sample finds it.
#pragma once

#include "common/image/rgb.h"

#include <cmath>
#include <optional>

namespace duet {

/// What flows along the path that is built from wo: radiance to the camera, or importance to a light. Refraction scales
/// radiance by η² and leaves importance alone (Veach 1997, §5.2).
enum class TransportMode { kRadiance, kImportance };

struct BsdfSample {
    Vec3 wi;
    Rgb weight;            ///< f·|cos θᵢ| / pdf
    float pdf = 0;         ///< by solid angle; of the choice of the lobe where specular
    bool specular = false; ///< a delta lobe: no light sampling can find it
    bool transmitted = false;
};

inline float cos_theta(Vec3 w) { return w.z; }
inline float abs_cos_theta(Vec3 w) { return abs(w.z); }
inline bool same_hemisphere(Vec3 a, Vec3 b) { return a.z * b.z > 0; }

/// A direction that a Bsdf without delta lobes has drawn as its sample: density and weight are those of the very
/// direction, rounded as it is.
template <typename BsdfType> BsdfSample sample_of(const BsdfType& bsdf, Vec3 wo, Vec3 wi, TransportMode mode) {
    const float density = bsdf.pdf(wo, wi, mode);
    return {wi, bsdf.eval(wo, wi, mode) * (abs_cos_theta(wi) / density), density};
}

/// The direction to the viewer, in the shading frame, kept on the side that is really seen. Interpolated normals make
/// surfaces near their silhouette face away though they are seen: there wo is lifted just above the shading horizon, or
/// the material would show its other side, as a dark rim. `side` is the sign of the geometric normal's cosine with the
/// viewer.
template <typename T> Vec3T<T> lifted_above_horizon(Vec3T<T> wo, T side) {
    constexpr float kLowest = 1e-4f;
    const auto seen = wo.z * side >= T(kLowest);
    if constexpr (Arithmetic<T>)
        if (seen) return wo; // nearly always
    const T zero(0.0f), flat = sqrt(wo.x * wo.x + wo.y * wo.y), scale = T(std::sqrt(1 - kLowest * kLowest)) / flat;
    const Vec3T<T> along = select(flat == zero, Vec3T<T>(zero, zero, side),
                                  Vec3T<T>(wo.x * scale, wo.y * scale, T(kLowest) * side));
    return select(seen, wo, along);
}

} // namespace duet

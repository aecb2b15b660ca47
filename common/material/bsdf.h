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
inline Vec3 lifted_above_horizon(Vec3 wo, float side) {
    constexpr float kLowest = 1e-4f;
    if (wo.z * side >= kLowest) return wo;
    const float flat = std::sqrt(wo.x * wo.x + wo.y * wo.y);
    if (flat == 0) return {0, 0, side};
    const float scale = std::sqrt(1 - kLowest * kLowest) / flat;
    return {wo.x * scale, wo.y * scale, kLowest * side};
}

} // namespace duet

// What every material's scattering function has in common, and the closed set of them.
//
// Conventions, tested for each material: wo (to the viewer) and wi (to the light) are unit vectors in the local shading
// frame, n = +z, both pointing away from the surface. eval is the BSDF without the cosine. sample returns
// weight = f·|cos θᵢ| / pdf. pdf is by solid angle of wi; for a specular lobe (a delta distribution) eval and pdf are 0
// and only sample finds it.
#pragma once

#include "common/image/rgb.h"

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

} // namespace duet

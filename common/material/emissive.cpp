#include "common/material/emissive.h"

#include "common/material/reflectance.h"

namespace duet {

DiffuseBsdf Emissive::at(const TextureSet& textures, const SurfacePoint& point) const {
    return {evaluate_reflectance(textures, albedo, point)};
}

} // namespace duet

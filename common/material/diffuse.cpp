#include "common/material/diffuse.h"

#include "common/material/reflectance.h"

namespace duet {

DiffuseBsdf Diffuse::at(const TextureSet& textures, const SurfacePoint& point) const {
    return {evaluate_reflectance(textures, albedo, point)};
}

RoughDiffuseBsdf Diffuse::rough_at(const TextureSet& textures, const SurfacePoint& point) const {
    return {evaluate_reflectance(textures, albedo, point), evaluate_clamped(textures, roughness, point)};
}

} // namespace duet

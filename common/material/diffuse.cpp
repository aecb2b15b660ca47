#include "common/material/diffuse.h"

#include "common/material/reflectance.h"

namespace duet {

DiffuseBsdf Diffuse::at(const TextureSet& textures, const SurfacePoint& point) const {
    return {evaluate_reflectance(textures, albedo, point)};
}

RoughDiffuseBsdf Diffuse::rough_at(const TextureSet& textures, const SurfacePoint& point) const {
    return {evaluate_reflectance(textures, albedo, point), clamp(evaluate(textures, roughness, point), 0.0f, 1.0f)};
}

} // namespace duet

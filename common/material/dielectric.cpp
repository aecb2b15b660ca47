#include "common/material/dielectric.h"

#include "common/material/reflectance.h"

namespace duet {

template struct DielectricBsdfT<float>;

DielectricBsdf Dielectric::at(const TextureSet& textures, const SurfacePoint& point) const {
    return {ior, evaluate_reflectance(textures, tint, point)};
}

ThinDielectricBsdf Dielectric::thin_at(const TextureSet& textures, const SurfacePoint& point) const {
    return {ior, evaluate_reflectance(textures, tint, point)};
}

RoughDielectricBsdf Dielectric::rough_at(const TextureSet& textures, const SurfacePoint& point) const {
    return {ior, evaluate_reflectance(textures, tint, point), sqr(evaluate_clamped(textures, roughness, point))};
}

} // namespace duet

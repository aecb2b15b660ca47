// One material for all that is opaque, by metalness and roughness, as glTF has it.
#pragma once

#include "common/material/layered.h"
#include "common/texture/texture.h"

namespace duet {

/// glTF 2.0's metallic-roughness material (specification, §3.9.2 and appendix B) with KHR_materials_ior and
/// KHR_materials_clearcoat. The same layers and the same Fresnel term; the layers conserve energy, where the
/// specification's sample formulas darken rough ones.
struct Principled {
    RgbSlot base_color{Rgb(1.0f)}; ///< diffuse albedo where it is no metal, reflectance at normal incidence where it is
    ScalarSlot metallic{1};        ///< 0: a dielectric over a diffuse surface; 1: a metal
    ScalarSlot roughness{1};       ///< perceptual; GGX alpha = roughness², at least LayeredBsdf::kSmoothest
    float ior = 1.5f;              ///< of the dielectric, in [1, 4]
    ScalarSlot clearcoat{0};       ///< how much of a clear coat over it all, in [0, 1]
    ScalarSlot clearcoat_roughness{0};

    LayeredBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
};

/// Plastic, varnish, glazed clay: a diffuse surface under a layer of a dielectric, which reflects light back down to
/// it, too: colours under it are deeper than bare.
struct Coated {
    RgbSlot albedo{Rgb(0.5f)};  ///< of the diffuse surface by itself
    ScalarSlot roughness{0.1f}; ///< of the coat
    float ior = 1.5f;           ///< of the coat, in [1, 4]

    LayeredBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet

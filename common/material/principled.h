// This file defines the opaque materials with layers: glTF's metallic-roughness material, and a coated diffuse
// surface.
#pragma once

#include "common/material/subsurface.h"
#include "common/texture/texture.h"

namespace duet {

/// Principled is glTF 2.0's metallic-roughness material (specification, §3.9.2 and appendix B) with
/// KHR_materials_ior and KHR_materials_clearcoat. It has the same layers and the same Fresnel term. Its layers
/// conserve energy, while the specification's sample formulas darken rough surfaces.
struct Principled {
    /// This is the diffuse albedo of the dielectric, and the reflectance at normal incidence of the metal.
    RgbSlot base_color{Rgb(1.0f)};
    ScalarSlot metallic{1};        ///< 0: a dielectric over a diffuse surface; 1: a metal
    ScalarSlot roughness{1};       ///< perceptual; GGX alpha = roughness², at least LayeredBsdf::kSmoothest
    float ior = 1.5f;              ///< index of refraction of the dielectric, in [1, 4]
    ScalarSlot clearcoat{0};       ///< fraction of the surface that a clear coat covers, in [0, 1]
    ScalarSlot clearcoat_roughness{0};
    ScalarSlot subsurface{0}; ///< fraction of the diffuse surface that is subsurface scattering instead, in [0, 1]
    Rgb mean_free_path{0.0f}; ///< of light inside, in meters; black: there is no subsurface scattering

    /// Returns the BSDF at a point, without subsurface scattering.
    LayeredBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    /// Returns the BSDF of the surface of a solid, seen from outside.
    SubsurfaceBsdf subsurface_at(const TextureSet& textures, const SurfacePoint& point) const;
};

/// Coated is a diffuse surface under a dielectric layer: plastic, varnish, glazed clay. The layer also reflects light
/// back down, so colors are more saturated than on the bare surface. With a mean free path it is a solid of subsurface
/// scattering under that layer.
struct Coated {
    RgbSlot albedo{Rgb(0.5f)};  ///< albedo of the bare diffuse surface
    ScalarSlot roughness{0.1f}; ///< roughness of the coat, perceptual
    float ior = 1.5f;           ///< index of refraction of the coat, in [1, 4]
    Rgb mean_free_path{0.0f};   ///< of light inside, in meters; black: there is no subsurface scattering

    /// Returns the BSDF at a point, without subsurface scattering.
    LayeredBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    /// Returns the BSDF of the surface of a solid, seen from outside.
    SubsurfaceBsdf subsurface_at(const TextureSet& textures, const SurfacePoint& point) const;
    /// Returns the fraction of diffuse light from below that the coat reflects back down.
    float internal_reflectance() const;
};

} // namespace duet

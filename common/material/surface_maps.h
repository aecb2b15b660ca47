// Pictures that change the surface itself, whatever it is made of: its normals, and where it is at all.
#pragma once

#include "common/texture/texture.h"

#include <concepts>
#include <cstdint>
#include <type_traits>

namespace duet {

/// The maps of one material. Textures are indices into TextureSet::textures, −1: none.
struct SurfaceMaps {
    std::int32_t normal = -1; ///< tangent-space normals: colours 0 to 1 mean components −1 to 1 along u, v and ns
    float normal_scale = 1;   ///< multiplies the first two components
    std::int32_t bump = -1;   ///< heights, of its red channel, along ns
    float bump_scale = 1;     ///< metres of a height of 1
    ScalarSlot opacity;       ///< 1: all there; 0: a hole; in between the part of the light that is stopped
    float cutoff = 0;         ///< above 0: all there where opacity is at least this, else a hole

    bool bends_normals() const { return normal >= 0 || bump >= 0; }
    bool cuts_out() const { return !opacity.constant() || opacity.value < 1; }
};

/// Calls visit(texture) for each reference to a texture: an index, or −1.
template <typename AnyMaps, typename Visit>
    requires std::same_as<std::remove_const_t<AnyMaps>, SurfaceMaps>
void for_each_texture(AnyMaps& maps, const Visit& visit) {
    visit(maps.normal);
    visit(maps.bump);
    visit(maps.opacity.texture);
}

/// Turns the shading normal by the material's maps as it is seen along `direction`: by the normal map in the frame of ns
/// and the surface's own u direction (as glTF 2.0, §3.9.3; the frame is each triangle's own, where MikkTSpace has means
/// over vertices), by the bump map along the surface gradient of its heights (Mikkelsen 2010, «Bump Mapping Unparametrized
/// Surfaces on the GPU»; Blinn 1978). Then bends it, where need be, so that the mirror direction stays above the surface
/// (Keller et al. 2017, «The Iray Light Transport Simulation and Rendering System», §A.3). As it is where u and v have no
/// direction.
void bend_normal(const TextureSet& textures, const SurfaceMaps& maps, Vec3 direction, SurfacePoint& point);

/// How much of the surface is there, in [0, 1]; 0 or 1 with a cutoff. Never filtered by the sample's footprint, so that
/// both pipelines, whose rays through a pixel are the same, agree on what is a hole.
float opacity(const TextureSet& textures, const SurfaceMaps& maps, const SurfacePoint& point);

} // namespace duet

// This file defines the maps that modify a surface of any material: normal, bump and opacity maps.
#pragma once

#include "common/texture/texture.h"

#include <concepts>
#include <cstdint>
#include <type_traits>

namespace duet {

/// SurfaceMaps are the maps of one material. Textures are indices into TextureSet::textures, or −1 for none.
struct SurfaceMaps {
    std::int32_t normal = -1; ///< tangent-space normals: colors 0 to 1 mean components −1 to 1 along u, v and ns
    float normal_scale = 1;   ///< factor of the normal map's first two components
    std::int32_t bump = -1;   ///< bump map: heights along ns, from the red channel
    float bump_scale = 1;     ///< meters that a height of 1 stands for
    ScalarSlot opacity;       ///< 1: opaque; 0: a hole; in between the fraction of light that the surface stops
    float cutoff = 0;         ///< alpha-test threshold: opaque where opacity is at least this, else a hole; 0: no test

    bool perturbs_normal() const { return normal >= 0 || bump >= 0; }
    bool has_transparency() const { return !opacity.constant() || opacity.value < 1; }
};

/// Calls visit(texture) for each reference to a texture, an index or −1.
template <typename AnyMaps, typename Visit>
    requires std::same_as<std::remove_const_t<AnyMaps>, SurfaceMaps>
void for_each_texture(AnyMaps& maps, const Visit& visit) {
    visit(maps.normal);
    visit(maps.bump);
    visit(maps.opacity.texture);
}

/// Applies the material's bump and normal map to the shading normal of a point seen along `direction`. The bump map
/// uses the surface gradient of its heights (Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU"; Blinn
/// 1978). The normal map applies in the frame of ns and the surface's u direction (glTF 2.0, §3.9.3; the frame is
/// that of each triangle, while MikkTSpace averages over vertices). The result is bent where necessary, so that the
/// mirror direction stays above the surface (Keller et al. 2017, "The Iray Light Transport Simulation and Rendering
/// System", §A.3). A map has no effect where the uv parametrization is degenerate.
void apply_normal_maps(const TextureSet& textures, const SurfaceMaps& maps, Vec3 direction, SurfacePoint& point);

/// Returns the opacity in [0, 1], or 0 or 1 with a cutoff. It is never filtered by the sample's footprint, so that
/// both pipelines, which trace the same rays through a pixel, agree on where the holes are.
float opacity(const TextureSet& textures, const SurfaceMaps& maps, const SurfacePoint& point);

} // namespace duet

// Ink lines where what is seen changes: an image-space stage over what each sample sees.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/shader/strip_shader.h"
#include "raster/visibility/cover.h"
#include "raster/visibility/depth_tile.h"

#include "common/image/image.h"

#include <memory>

namespace duet::raster {

/// What one sample a pixel sees.
struct SeenPicture {
    ImageFloat nearness;         ///< near / depth; 0: nothing
    Image<Vec3> normal;          ///< shading normal, halved and moved to [0, 1]
    Image<std::uint32_t> object; ///< kNoObject: nothing

    SeenPicture(int width, int height) : nearness(width, height), normal(width, height), object(width, height) {}
    /// A tile's part. `normals`: smooth_normal_program's, for that tile.
    void add(const DepthTile& tile, const Geometry& geometry, StripShader& normals);
    /// And before it surfaces with holes and veils, of process_layers: the nearest beyond which less than half of the light is
    /// seen. `tile`: of what is behind them; `offset`: its samples'.
    void add_layers(const PreparedData& data, const Geometry& layers, const PassView& view, SampleOffset offset, std::size_t tile_index,
                    const HitTile& tile, const Program& normals);
};

/// How much ink a pixel takes, in [0, 1], by the strongest of three: another object beside it; a step in depth; a crease.
///
/// Steps are found by the second difference of nearness, which is linear in the picture over any plane, however it leans
/// (where depth's first difference draws over every floor seen at a low angle): from 2 % of its own on, at 4 % in full.
/// Creases by Sobel's operator on the normal's three components, scaled to the change across an edge: from 0.5 on (about
/// 29°), at 0.8 (47°) in full. (Saito and Takahashi 1990, «Comprehensible Rendering of 3-D Shapes», have Sobel's operator
/// on depth for profiles and second differences for inner edges; Decaudin 1996, «Cartoon-Looking Rendering of 3D-Scenes»,
/// adds the normals.)
float ink(const SeenPicture& seen, int x, int y);

} // namespace duet::raster

// Implements the last stages for images that go directly to a display or a shadow map. They have one sample per
// pixel, and each tile is completed while it is in the cache.
#pragma once

#include "raster/raster_scene.h"
#include "raster/visibility/hit_tile.h"

namespace duet::raster {

/// Rasterizes, shades and encodes a tile. `program` is null for Shading::kLit. `index` is the tile's index in its
/// grid.
void display_tile(const RasterSceneData& data, const RasterSettings& settings, const ShaderProgram* program,
                  const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                  Image<Rgba8>& image);

/// Rasterizes a tile and stores its reversed depth, near / depth; 0 on a miss.
void render_depth_tile(const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                       ImageFloat& image);

/// Does the same as render_depth_tile() and stores the colors of `program`. `colors` is not changed where nothing is
/// visible.
void render_depth_and_color_tile(const RasterSceneData& data, const Geometry& geometry, const PassView& view,
                                 const ShaderProgram& program, const PixelRect& rect, std::size_t index,
                                 ImageFloat& reversed_depth, ImageRgb& colors);

/// Encodes an image of radiance as 8-bit sRGB.
void encode(const ImageRgb& radiance, int threads, Image<Rgba8>& image);

} // namespace duet::raster

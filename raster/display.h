// Implements the last stages for images that go directly to a display or a shadow map. They have one sample per
// pixel, and each tile is completed while it is in the cache.
#pragma once

#include "raster/prepare.h"
#include "raster/visibility/cover.h"

namespace duet::raster {

/// Rasterizes, shades and encodes a tile. `program` is null for Shading::kLit. `index` is the tile's index in its
/// grid.
void display_tile(const PreparedData& data, const Settings& settings, const Program* program, const Geometry& geometry,
                  const PassView& view, const PixelRect& rect, std::size_t index, Image<Rgba8>& picture);

/// Rasterizes a tile and stores its reversed depth, near / depth; 0 on a miss.
void keep_nearness(const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                   ImageFloat& picture);

/// Does the same as keep_nearness() and stores the colors of `program`. `colors` is not changed where nothing is
/// visible.
void keep_nearness_and_colors(const PreparedData& data, const Geometry& geometry, const PassView& view,
                              const Program& program, const PixelRect& rect, std::size_t index, ImageFloat& nearness,
                              ImageRgb& colors);

/// Encodes an image of radiance as 8-bit sRGB.
void encode(const ImageRgb& radiance, int threads, Image<Rgba8>& picture);

} // namespace duet::raster

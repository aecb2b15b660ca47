// Implements stage 6 for a tile: draws all primitives that may overlap it.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/visibility/depth_tile.h"

namespace duet::raster {

/// Rasterizes all primitives that overlap a tile of the image into `tile`: reversed depth and the id of the visible
/// primitive per sample. `index` is the tile's index in its grid. rasterize_tile() initializes every sample;
/// rasterize_drawn_blocks() leaves the samples of blocks without any primitive undefined.
void rasterize_drawn_blocks(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
                            std::size_t index, DepthTile& tile);
/// Does the same as rasterize_drawn_blocks, and clears the blocks without any primitive.
void rasterize_tile(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
                    std::size_t index, DepthTile& tile);

} // namespace duet::raster

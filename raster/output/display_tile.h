// Implements the last stages for images that go directly to a display. They have one sample per pixel, and each tile is
// completed while it is in the cache.
#pragma once

#include "raster/raster_scene.h"
#include "raster/visibility/hit_tile.h"

namespace duet::raster {

class ShaderProgram; // raster/shader/packet_shader.h

/// Rasterizes a tile, shades it with a program and encodes it. `index` is the tile's index in its grid.
void display_tile(const RasterSceneData& data, const ShaderProgram& program, const Geometry& geometry,
                  const PassView& view, const PixelRect& rect, std::size_t index, Image<Rgba8>& image);

/// Encodes an image of radiance as 8-bit sRGB.
void encode(const ImageRgb& radiance, int threads, Image<Rgba8>& image);

} // namespace duet::raster

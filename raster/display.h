// The end of the pipeline for pictures that go straight to a display or a shadow map: a sample a pixel, and each tile
// finished while it lies in the cache.
#pragma once

#include "raster/prepare.h"
#include "raster/visibility/cover.h"

namespace duet::raster {

/// Draws a tile and shades, encodes and keeps its pixels; `program` is null for Shading::kLit.
void display_tile(const PreparedData& data, const Settings& settings, const Program* program, const Geometry& geometry,
                  const PassView& view, const PixelRect& rect, std::size_t index, Image<Rgba8>& picture);

/// Draws a tile and keeps its depths, as near / depth.
void keep_nearness(const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                   ImageFloat& picture);

/// The same, and what a program shows there, black where nothing is.
void keep_nearness_and_colors(const PreparedData& data, const Geometry& geometry, const PassView& view, const Program& program,
                              const PixelRect& rect, std::size_t index, ImageFloat& nearness, ImageRgb& colors);

/// A whole picture of radiance, encoded.
void encode(const ImageRgb& radiance, int threads, Image<Rgba8>& picture);

} // namespace duet::raster

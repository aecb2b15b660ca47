// Deferred shading of Shading::kLit: each stage is a function over the whole G-buffer, and adds one effect.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/geometry/geometry.h"
#include "raster/geometry/tiles.h"

namespace duet {
struct Control;
}

namespace duet::raster {

/// Returns the radiance of one sample per pixel, at `offset` in its pixel.
Planes3 shade_deferred(const PreparedData& data, const Settings& settings, const Geometry& geometry,
                       const PassView& view, const TileGrid& grid, SampleOffset offset, const Control& control);

} // namespace duet::raster

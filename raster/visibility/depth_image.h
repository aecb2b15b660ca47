// Renders only depth, with one sample per pixel, for shadow maps.
#pragma once

#include "raster/raster_scene.h"
#include "raster/visibility/hit_tile.h"

namespace duet::raster {

/// Rasterizes a tile and stores its reversed depth, near / depth; 0 on a miss. `layers`, from process_layers, holds the
/// alpha-masked and alpha-blended surfaces; it is null if there are none.
///
/// With layers, a pixel stores the first surface that stops its light. Fully transparent points never do and opaque
/// surfaces always do. A surface of partial opacity stops the light of that fraction of the pixels, so the mean over
/// pixels equals that of blending (Enderton, Sintorn, Shirley and Luebke 2010, "Stochastic Transparency", §3.4).
///
/// There are two differences from the paper. First, a pixel has one threshold for all its surfaces: the first surface
/// at which the accumulated opacity exceeds the threshold stops the light, so the transmittances of stacked surfaces
/// multiply. Second, the thresholds are not independent but form an ordered dither of 4 × 4 pixels, which is the width
/// of the filter that samples shadow maps with layers. Within the filter, thresholds with a rank above or below the
/// opacity cause no error. The one rank in between, whose pixels the hash decides, causes an rms error of at most half
/// a sixteenth of the light.
void render_depth_tile(const RasterSceneData& data, const Geometry& geometry, const Geometry* layers,
                       const PassView& view, const PixelRect& rect, std::size_t index, ImageFloat& image);

/// Returns the reversed depth of a view at the pixels' centers when the shutter opens, without the object `excluded`.
/// `threads` = 0 stands for all.
ImageFloat render_depth(const RasterSceneData& data, const View& view, int threads,
                        std::uint32_t excluded = kNoObject);

} // namespace duet::raster

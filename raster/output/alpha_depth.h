// Renders depth maps, as a shadow map needs them, with alpha-masked and alpha-blended surfaces.
#pragma once

#include "raster/raster_scene.h"
#include "raster/visibility/hit_tile.h"

namespace duet::raster {

/// Renders reversed depth as render_depth_tile() (raster/output/display_tile.h) does, with alpha-masked and
/// alpha-blended surfaces. A texel stores the first surface that stops its light. Fully transparent points never do and
/// opaque surfaces always do. A surface of partial opacity stops the light of that fraction of the texels, so the mean
/// over texels equals that of blending (Enderton, Sintorn, Shirley and Luebke 2010, "Stochastic Transparency", §3.4).
///
/// There are two differences. First, a texel has one threshold for all its surfaces: the first surface at which the
/// accumulated opacity exceeds the threshold stops the light, so the transmittances of stacked surfaces multiply.
/// Second, the thresholds are not independent but form an ordered dither of 4 × 4 texels, which is the width of the
/// filter that ShadowMap::lit_fraction applies to maps with layers. Within the filter, thresholds with a rank above
/// or below the opacity cause no error. The one rank in between, whose texels the hash decides, causes an rms error
/// of at most half a sixteenth of the light.
///
/// `layers` comes from process_layers. Where there are none, the result is bit-identical to render_depth_tile().
void render_alpha_depth_tile(const RasterSceneData& data, const Geometry& geometry, const Geometry& layers,
                             const PassView& view, const PixelRect& rect, std::size_t index, ImageFloat& image);

/// Returns the dither threshold of a texel, in [0, 1): a rank of Bayer's matrix (1973, "An Optimum Method for
/// Two-Level Rendition of Continuous-Tone Images") plus a hash within its step of 1/16, so that the mean is exact
/// for every opacity.
float dither(int x, int y);

} // namespace duet::raster

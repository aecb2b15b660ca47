// Depths alone where surfaces have holes or let a part of the light through, as a shadow map takes them.
#pragma once

#include "raster/prepare.h"
#include "raster/visibility/cover.h"

namespace duet::raster {

/// keep_nearness() (raster/display.h) with surfaces that may be seen through: a texel keeps the first of its surfaces
/// that stops its light. Holes never do, whole surfaces always, and in between the part of the texels that their opacity
/// says, so that the mean over texels is that of blending (Enderton, Sintorn, Shirley and Luebke 2010, «Stochastic
/// Transparency», §3.4). Two departures: a texel has one number for all its surfaces, and what stops it is where the
/// light that has passed the layers so far falls below that, so that stacked veils let through the product; and the
/// numbers are not independent but the ranks of an ordered dither of 4 × 4 texels, as wide as the filter that
/// ShadowMap::lit_fraction takes to maps with layers. That leaves nothing of ranks that are above the opacity or below
/// it, and of the one between, whose texels the hash decides, at most half a sixteenth of the light, rms.
/// `layers`: of process_layers. The same bits as keep_nearness() where they are not.
void keep_layered_nearness(const PreparedData& data, const Geometry& geometry, const Geometry& layers, const PassView& view,
                           const PixelRect& rect, std::size_t index, ImageFloat& picture);

/// The texel's number, in [0, 1): a rank of Bayer's matrix (1973, «An Optimum Method for Two-Level Rendition of
/// Continuous-Tone Pictures») and, within its step of 1/16, a hash, so that the mean is exact for every opacity.
float dither(int x, int y);

} // namespace duet::raster

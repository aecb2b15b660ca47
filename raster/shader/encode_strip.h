// Strips of pixels to 8-bit sRGB.
#pragma once

#include "raster/lanes.h"

#include "common/image/rgb.h"

#include <span>

namespace duet::raster {

/// Sixteen colours, linear.
using StripColors = RgbT<StripOf<float>>;

/// Codes, sixteen of them, in one row of the cache.
using StripCodes = StripOf<Rgba8>;

/// Of each strip its codes as SrgbEncoder gives them, for every float; opaque. The background's where the strip's `seen` has no bit
/// for a sample. As many of both as there are colours; any number at a time: many are faster than one by one.
void encode_strips(std::span<const StripColors> colors, const std::uint32_t* seen, Rgba8 background, StripCodes* const* codes);

} // namespace duet::raster

// A strip of pixels to 8-bit sRGB.
#pragma once

#include "raster/lanes.h"

#include "common/image/rgb.h"

namespace duet::raster {

/// Sixteen colours, linear.
using StripColors = RgbT<StripOf<float>>;

/// Codes, sixteen of them, in one row of the cache.
using StripCodes = StripOf<Rgba8>;

/// Codes as SrgbEncoder gives them, for every float; opaque. The background's where `seen` has no bit for a sample.
void encode_strip(const StripColors& colors, std::uint32_t seen, Rgba8 background, StripCodes& codes);

} // namespace duet::raster

// A strip of pixels to 8-bit sRGB.
#pragma once

#include "raster/lanes.h"

#include "common/image/rgb.h"

namespace duet::raster {

/// Sixteen colours, linear.
using StripColors = RgbT<StripOf<float>>;

/// Codes as SrgbEncoder gives them, for every float; opaque.
void encode_strip(const StripColors& colors, std::array<Rgba8, kStrip>& codes);

} // namespace duet::raster

// Converts packets of linear colors to 8-bit sRGB.
#pragma once

#include "raster/lanes.h"

#include "common/image/rgb.h"

#include <span>

namespace duet::raster {

/// Stores sixteen linear colors.
using StripColors = RgbT<StripOf<float>>;

/// Stores the shading normals and base colors of sixteen samples.
struct StripNormalsAndColors {
    Vec3T<StripOf<float>> normal;
    StripColors color;
};

/// Stores sixteen sRGB pixels, in one cache line.
using StripCodes = StripOf<Rgba8>;

/// Encodes packets. codes[k] receives the pixels of colors[k], opaque and bit-identical to SrgbEncoder for every
/// float. Samples whose bit in seen[k] is 0 receive `background`. `seen` and `codes` have as many entries as
/// `colors`. Encoding many packets in one call is faster than one by one.
void encode_strips(std::span<const StripColors> colors, const std::uint32_t* seen, Rgba8 background,
                   StripCodes* const* codes);

} // namespace duet::raster

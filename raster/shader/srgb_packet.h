// Converts packets of linear colors to 8-bit sRGB.
#pragma once

#include "raster/geometry/packet.h"

#include "common/image/rgb.h"

#include <span>

namespace duet::raster {

/// Stores sixteen linear colors.
using ColorPacket = RgbT<PacketOf<float>>;

/// Stores the SurfaceAttributes of sixteen samples.
struct PacketAttributes {
    Vec3T<PacketOf<float>> normal;
    PacketOf<float> bulge;
    ColorPacket color;
};

/// Stores sixteen sRGB pixels, in one cache line.
using SrgbPacket = PacketOf<Rgba8>;

/// Encodes packets. codes[k] receives the pixels of colors[k], opaque and bit-identical to SrgbEncoder for every
/// float. Samples whose bit in visible[k] is 0 receive `background`. `visible` and `codes` have as many entries as
/// `colors`. Encoding many packets in one call is faster than one by one.
void encode_packets(std::span<const ColorPacket> colors, const std::uint32_t* visible, Rgba8 background,
                    SrgbPacket* const* codes);

} // namespace duet::raster

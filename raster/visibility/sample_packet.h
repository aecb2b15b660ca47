// Describes the positions of a packet of sixteen samples of a tile, and the ids of their visible surfaces.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/geometry/packet.h"

#include <array>

namespace duet::raster {

/// Describes a packet of two rows of eight samples of a tile.
struct SamplePacket {
    int x = 0, y = 0;                  ///< first pixel
    const std::int32_t* ids = nullptr; ///< ids of the visible primitives (DepthTile::ids), aligned to 64 bytes
    /// The reversed depths (DepthTile::reversed_depth) are aligned to 64 bytes. If the pointer is null, they must be
    /// computed.
    const float* reversed_depth = nullptr;
    SampleOffset offset;               ///< position of every sample in its pixel
    const std::array<SampleOffset, kPacketSize>* offsets = nullptr; ///< per-sample offsets; null: all use `offset`

    bool whole_pixels = false; ///< multisampling: each sample represents a pixel, or a layer of it

    SampleOffset offset_of(std::size_t i) const { return offsets != nullptr ? (*offsets)[i] : offset; }
    Vec2d position(std::size_t i) const {
        return offset_of(i).position(x + static_cast<int>(i % kPacketWidth), y + static_cast<int>(i / kPacketWidth));
    }
};

/// Returns the number of shaded samples per pixel, which determines each sample's footprint.
inline int samples_per_pixel(const SamplePacket& place, const PassView& view) {
    return place.whole_pixels ? 1 : view.samples_per_pixel;
}

} // namespace duet::raster

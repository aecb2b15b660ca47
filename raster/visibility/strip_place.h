// Where sixteen samples of a tile lie, and what they see.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/lanes.h"

#include <array>

namespace duet::raster {

/// Two rows of eight samples of a tile.
struct StripPlace {
    int x = 0, y = 0;                  ///< the first pixel
    const std::int32_t* ids = nullptr; ///< of what each sees (DepthTile::ids); aligned to 64 bytes
    const float* nearness = nullptr;   ///< of each (DepthTile::nearness), likewise aligned; null: to be worked out
    std::uint32_t inside = 0;          ///< a bit for each that lies in the unsnapped triangle for certain, as far as is known
    SampleOffset offset;               ///< of every sample in its pixel
    const std::array<SampleOffset, kStrip>* offsets = nullptr; ///< or, where given, of each its own

    bool whole_pixels = false; ///< multisampling: each stands for a pixel, or what is seen of it

    SampleOffset offset_of(std::size_t i) const { return offsets != nullptr ? (*offsets)[i] : offset; }
    Vec2d position(std::size_t i) const {
        return offset_of(i).position(x + static_cast<int>(i % kStripWidth), y + static_cast<int>(i / kStripWidth));
    }
};

/// How many samples a pixel are shaded: so much of it each one stands for.
inline int samples_per_pixel(const StripPlace& place, const PassView& view) {
    return place.whole_pixels ? 1 : static_cast<int>(view.samples.size());
}

} // namespace duet::raster

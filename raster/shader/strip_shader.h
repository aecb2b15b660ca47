// What shades a picture, whatever it is: strips of samples in, colours out.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/shader/encode_strip.h"

#include "common/geometry/hit.h"

#include <memory>
#include <span>

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

/// Shades the strips of one tile, in any order.
class StripShader {
public:
    virtual ~StripShader() = default;
    /// Of each strip the colours of those samples that see something, and a bit for each of them; the others have any.
    /// Any number at a time: several are shaded faster than one by one.
    virtual void shade(std::span<const StripPlace> places, StripColors* colors, std::uint32_t* seen) = 0;
    std::uint32_t shade(const StripPlace& place, StripColors& colors) {
        std::uint32_t seen = 0;
        shade(std::span(&place, 1), &colors, &seen);
        return seen;
    }
};

/// A shader, ready for any tile.
class Program {
public:
    virtual ~Program() = default;
    virtual std::unique_ptr<StripShader> for_tile(const PreparedData& data, const Geometry& geometry, const PassView& view,
                                                  const PixelRect& tile) const = 0;
    /// One hit of the ray through `pixel`.
    virtual Rgb shade_hit(const PreparedData& data, const PassView& view, const Hit& hit, Vec2d pixel) const = 0;
};

} // namespace duet::raster

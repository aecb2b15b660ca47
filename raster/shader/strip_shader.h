// What shades a picture, whatever it is: strips of samples in, colours out.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/shader/encode_strip.h"
#include "raster/visibility/strip_place.h"

#include "common/geometry/hit.h"

#include <memory>
#include <span>

namespace duet::raster {

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

// Defines the interface of shading, which takes packets of samples and returns colors.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/shader/encode_strip.h"
#include "raster/visibility/strip_place.h"

#include "common/geometry/hit.h"

#include <memory>
#include <span>

namespace duet::raster {

/// Shades the packets of one tile, in any order. `Colors` is what a shader returns for a packet, StripColors or
/// StripNormalsAndColors.
template <typename Colors> class StripShaderOf {
public:
    virtual ~StripShaderOf() = default;
    /// Shades packets. colors[k] receives the colors of the samples of places[k], and seen[k] one bit per sample
    /// with a visible surface; the colors of the others are unspecified. Shading many packets in one call is faster
    /// than one by one.
    virtual void shade(std::span<const StripPlace> places, Colors* colors, std::uint32_t* seen) = 0;
    std::uint32_t shade(const StripPlace& place, Colors& colors) {
        std::uint32_t seen = 0;
        shade(std::span(&place, 1), &colors, &seen);
        return seen;
    }
};

using StripShader = StripShaderOf<StripColors>;

/// Holds a shader that can shade any tile.
class Program {
public:
    virtual ~Program() = default;
    virtual std::unique_ptr<StripShader> for_tile(const PreparedData& data, const Geometry& geometry,
                                                  const PassView& view, const PixelRect& tile) const = 0;
    /// Returns the color of one hit of the ray through `pixel`.
    virtual Rgb shade_hit(const PreparedData& data, const PassView& view, const Hit& hit, Vec2d pixel) const = 0;
};

} // namespace duet::raster

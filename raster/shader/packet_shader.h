// Defines the interface of shading, which takes packets of samples and returns colors.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/shader/srgb_packet.h"
#include "raster/visibility/sample_packet.h"

#include "common/geometry/hit.h"

#include <memory>
#include <span>

namespace duet::raster {

/// Shades the packets of one tile, in any order. `Colors` is the result for a packet: ColorPacket or PacketAttributes.
template <typename Colors> class PacketShaderOf {
public:
    virtual ~PacketShaderOf() = default;
    /// Shades packets. colors[k] receives the colors of the samples of packets[k], and visible[k] one bit per sample
    /// with a visible surface; the colors of the others are unspecified. Shading many packets in one call is faster
    /// than one by one.
    virtual void shade(std::span<const SamplePacket> packets, Colors* colors, std::uint32_t* visible) = 0;
    std::uint32_t shade(const SamplePacket& packet, Colors& colors) {
        std::uint32_t visible = 0;
        shade(std::span(&packet, 1), &colors, &visible);
        return visible;
    }
};

using PacketShader = PacketShaderOf<ColorPacket>;

/// Holds a shader that can shade any tile.
class ShaderProgram {
public:
    virtual ~ShaderProgram() = default;
    /// Returns a shader for the packets of one tile. The shader keeps references to the arguments.
    virtual std::unique_ptr<PacketShader> for_tile(const RasterSceneData& data, const Geometry& geometry,
                                                   const PassView& view, const PixelRect& tile) const = 0;
    /// Returns the color of one hit of the ray through `pixel`.
    virtual Rgb shade_hit(const RasterSceneData& data, const PassView& view, const Hit& hit, Vec2d pixel) const = 0;
};

} // namespace duet::raster

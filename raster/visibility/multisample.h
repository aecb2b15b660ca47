// Implements multisampling (MSAA): coverage and depth are evaluated at several samples per pixel, and each primitive
// visible in the pixel is shaded once (Akeley 1993, "RealityEngine Graphics", §3.3).
#pragma once

#include "raster/visibility/depth_tile.h"
#include "raster/visibility/sample_packet.h"

#include <vector>

namespace duet::raster {

/// Returns the positions of 2, 4, 8 or 16 samples: the rotated patterns that are standard in Direct3D 11
/// (D3D11_STANDARD_MULTISAMPLE_PATTERN) and in Vulkan ("Multisampling", standard sample locations). Each sample has
/// a row and a column to itself. Throws Error for any other number.
const std::vector<SampleOffset>& multisample_pattern(int count);

/// Holds one of the primitives visible in each pixel of a tile. If all samples of a pixel see the same primitive, it
/// is shaded at the pixel center, else at the centroid of the samples that see it. The centroid lies inside the
/// primitive, because triangles, quads and spheres are convex. The center could lie outside, where interpolation
/// would extrapolate.
class Layer {
public:
    /// Returns the number of the pixel's samples that see the primitive.
    int count(std::uint32_t sample_index) const { return counts_[sample_index]; }
    std::uint32_t id(std::uint32_t sample_index) const { return static_cast<std::uint32_t>(ids_[sample_index]); }

private:
    friend class LayeredTile;
    static constexpr std::size_t kTile = kTileSamples;
    alignas(64) std::array<std::int32_t, kTile> ids_;
    alignas(64) std::array<std::int32_t, kTile> counts_, sum_x_, sum_y_; ///< counts and summed offsets of samples
    std::array<bool, kTile / kPacketSize> used_;                         ///< packets with any nonzero count
};

/// Holds all primitives visible at the samples of a tile's pixels. It allocates as many layers as the pixel with the
/// most primitives needs.
class LayeredTile {
public:
    /// `count` is the number of samples per pixel.
    LayeredTile(const PixelRect& rect, int count) : rect_(rect), count_(count) {}

    /// Adds one sample of each pixel.
    void add(const DepthTile& tile);

    const PixelRect& rect() const { return rect_; }
    std::size_t layers() const { return layers_.size(); }
    const Layer& layer(std::size_t i) const { return *layers_[i]; }
    /// Holds the input of shading for a packet of two rows of eight pixels in one layer. `packet.ids` is null if the
    /// layer has none of these pixels. `offsets` stores the per-sample positions that `packet` may point to.
    struct LayerPacket {
        SamplePacket packet;
        std::array<SampleOffset, kPacketSize> offsets;
    };
    /// Fills `layer_packet` with the packet whose first pixel is (x, y).
    void layer_packet(std::size_t layer, int x, int y, LayerPacket& layer_packet) const;
    std::uint32_t sample_index(int x, int y) const {
        return tile_sample_index(static_cast<std::uint32_t>(x - rect_.x0), static_cast<std::uint32_t>(y - rect_.y0));
    }

private:
    void add_one(std::uint32_t sample_index, std::int32_t id, SampleOffset offset);
    Layer& layer_at(std::size_t i);

    PixelRect rect_;
    int count_;
    std::vector<std::unique_ptr<Layer>> layers_;
};

} // namespace duet::raster

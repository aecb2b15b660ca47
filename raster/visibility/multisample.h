// Multisampling (MSAA): coverage and depth at several samples a pixel, shading once for each primitive that they see
// (Akeley 1993, «RealityEngine Graphics», §3.3).
#pragma once

#include "raster/visibility/strip_place.h"
#include "raster/visibility/depth_tile.h"

#include <vector>

namespace duet::raster {

/// Where 2, 4, 8 or 16 samples lie: the rotated patterns that Direct3D 11 calls standard
/// (D3D11_STANDARD_MULTISAMPLE_PATTERN) and Vulkan, too («Multisampling», standard sample locations): each sample has
/// a row and a column to itself. Throws Error for another number.
const std::vector<SampleOffset>& multisample_pattern(int count);

/// One of what the samples of each pixel of a tile see. Where all of a pixel's samples see the same, it is shaded at the
/// pixel's centre; else at the centroid of the samples that see it, which lies in it, for triangles, quads and spheres
/// are convex. The centre could lie outside, where interpolation would make up what is not there.
class Layer {
public:
    /// Samples of the pixel that see it.
    int count(std::uint32_t place) const { return counts_[place]; }
    std::uint32_t id(std::uint32_t place) const { return static_cast<std::uint32_t>(ids_[place]); }

private:
    friend class LayeredTile;
    static constexpr std::size_t kTile = kTileSamples;
    alignas(64) std::array<std::int32_t, kTile> ids_;
    alignas(64) std::array<std::int32_t, kTile> counts_, sum_x_, sum_y_; ///< offsets added up
    std::array<bool, kTile / kStrip> used_;                              ///< strips with any count
};

/// All that the samples of a tile's pixels see. Takes memory for as many layers as its most crowded pixel has.
class LayeredTile {
public:
    /// `count`: samples a pixel.
    LayeredTile(const PixelRect& rect, int count) : rect_(rect), count_(count) {}

    /// What one sample of each pixel sees.
    void add(const DepthTile& tile);

    const PixelRect& rect() const { return rect_; }
    std::size_t layers() const { return layers_.size(); }
    const Layer& layer(std::size_t i) const { return *layers_[i]; }
    /// Two rows of eight pixels from (x, y) on, in a layer: ready to be shaded, with its own memory for their places.
    /// `ids` is null where the layer has none of them.
    struct Strip {
        StripPlace place;
        std::array<SampleOffset, kStrip> offsets;
    };
    void strip(std::size_t layer, int x, int y, Strip& strip) const;
    std::uint32_t place(int x, int y) const {
        return place_in_tile(static_cast<std::uint32_t>(x - rect_.x0), static_cast<std::uint32_t>(y - rect_.y0));
    }

private:
    void add_one(std::uint32_t place, std::int32_t id, SampleOffset offset);
    Layer& layer_at(std::size_t i);

    PixelRect rect_;
    int count_;
    std::vector<std::unique_ptr<Layer>> layers_;
};

} // namespace duet::raster

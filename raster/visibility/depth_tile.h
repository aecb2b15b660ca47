// Implements stage 6, which determines the visible triangle of each sample of a tile.
#pragma once

#include "raster/geometry/batch.h"
#include "raster/geometry/triangles.h"
#include "raster/lanes.h"

#include <array>
#include <span>

namespace duet::raster {

/// Holds the depth buffer of a tile, one sample per pixel: reversed depth and the id of the visible primitive.
///
/// Reversed depth (`nearness`) is near / depth, in (0, 1], as a float. Its relative error is 2^-24 at any depth, as
/// that of Hit::t itself, and no precision is lost to a far plane. At equal depth the lower id wins, so the result
/// does not depend on the drawing order.
///
/// Samples are stored in blocks of 8 × 8 (place_in_tile). Each block has a bound of its farthest sample; primitives
/// entirely behind it are culled (Greene, Kass and Miller 1993, "Hierarchical Z-Buffer Visibility", with two
/// levels).
class DepthTile {
public:
    DepthTile() {} // members are uninitialized until reset()

    /// Clears the tile and sets its rectangle, at most TileGrid::kTileSize pixels per side. The samples of a block
    /// are initialized when it is first drawn to.
    void reset(const PixelRect& rect, SampleOffset offset, const Viewport& viewport);

    /// Draws a triangle. `whole` gives access to the unsnapped, unclipped triangle, which is needed for samples
    /// near edges.
    void draw(const DrawTriangle& triangle, const WholeTriangles& whole);
    /// Draws a small triangle's coverage mask, with its depth plane.
    void draw(const Patch& patch);
    /// Draws single samples.
    void draw(std::span<const Fragment> fragments);
    /// Draws one sample of pixel (x, y).
    void draw(int x, int y, std::uint32_t id, float nearness) { keep_one(place(x, y), id, nearness, false); }

    const PixelRect& rect() const { return rect_; }
    SampleOffset offset() const { return offset_; }
    /// Returns the id of the visible primitive; kNoTriangle if there is none.
    std::uint32_t id(int x, int y) const {
        const std::uint32_t at = place(x, y);
        return drawn(at / kBlockSamples) ? static_cast<std::uint32_t>(ids_[at]) : kNoTriangle;
    }
    /// Returns the reversed depth, near / depth; 0 if no primitive is visible.
    float nearness(int x, int y) const {
        const std::uint32_t at = place(x, y);
        return drawn(at / kBlockSamples) ? nearness_[at] : 0;
    }
    /// Returns the index at which pixel (x, y) is stored.
    std::uint32_t place(int x, int y) const {
        return place_in_tile(static_cast<std::uint32_t>(x - rect_.x0), static_cast<std::uint32_t>(y - rect_.y0));
    }
    /// Clears the samples of blocks that were not drawn to.
    void empty_undrawn();
    /// The arrays are in storage order. They are valid in blocks drawn to, and everywhere after empty_undrawn().
    const std::int32_t* ids() const { return ids_.data(); }
    const float* nearness() const { return nearness_.data(); }
    /// Returns one bit per sample of the packet that starts at `place`, set if the sample lies inside the unsnapped
    /// visible triangle (edge_margins).
    std::uint32_t inside(std::size_t place) const { return inside_[place / kStrip]; }
    /// Returns true if any sample of the block was drawn to.
    bool drawn(std::size_t block) const { return drawn_[block]; }

    static constexpr int kBlock = 8;
    static constexpr int kBlocks = TileGrid::kTileSize / kBlock; ///< per side
    static_assert(kBlocks <= static_cast<int>(kStrip) && kBlocks % Floats::size == 0);
    static constexpr int kStripRows = kStrip / kStripWidth;

private:
    struct Edges;
    struct BlockRow;
    template <std::size_t kSide> struct Nearness;
    struct Covered;
    std::uint32_t not_hidden(int row, float nearest) const;
    void draw_block(const DrawTriangle& triangle, const WholeTriangles& whole, std::size_t block,
                    const Covered& covered, Vec2d first);
    template <typename NearnessAt>
    void draw_strip(std::size_t block, std::size_t first, std::uint64_t samples, std::uint32_t id,
                    const NearnessAt& nearness_at);
    template <typename Lanes>
    void keep_nearest(std::size_t place, std::int32_t id, const Floats& nearness, const Lanes& lanes);
    void draw_edge_samples(const DrawTriangle& triangle, const WholeTriangles& whole, std::size_t block,
                           std::uint64_t samples);
    void keep_one(std::size_t place, std::uint32_t id, float nearness, bool inside);
    void find_farthest(std::size_t block);
    void empty(std::size_t block);
    void open(std::size_t block) {
        if (!drawn_[block]) empty(block);
        drawn_[block] = true;
    }

    PixelRect rect_;
    SampleOffset offset_;
    Viewport viewport_;
    alignas(64) std::array<float, kTileSamples> nearness_;
    alignas(64) std::array<std::int32_t, kTileSamples> ids_;
    static_assert(kStrip == 16);
    std::array<std::uint16_t, kTileSamples / kStrip> inside_; ///< one mask per packet
    /// No sample of a block has less reversed depth than its bound.
    alignas(64) std::array<float, kBlocks * kBlocks> farthest_;
    std::array<std::uint8_t, kBlocks * kBlocks> partial_;  ///< number of draws since `farthest_` was computed
    std::array<bool, kBlocks * kBlocks> drawn_;
};

} // namespace duet::raster

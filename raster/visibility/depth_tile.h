// Stage 6: which triangle each sample of a tile sees.
#pragma once

#include "raster/geometry/batch.h"
#include "raster/geometry/triangles.h"
#include "raster/lanes.h"

#include <array>
#include <span>

namespace duet::raster {

/// One sample a pixel of a tile: how near what it sees is, and the number of it.
///
/// Nearness is reversed depth, near / depth, in (0, 1], as a float: its relative error is 2^-24 at any depth, as that
/// of Hit::t itself, and nothing is lost to a far plane. Of equal nearness the lower number wins, so that the result
/// does not depend on the order of drawing.
///
/// Samples lie by blocks of 8 × 8 (place_in_tile). Each block knows how near its farthest sample is at least: what is
/// wholly behind that is left out (Greene, Kass and Miller 1993, «Hierarchical Z-Buffer Visibility», of two levels).
class DepthTile {
public:
    DepthTile() {} // what is not reset has no contents

    /// Empties the tile and moves it: at most TileGrid::kTileSize pixels a side. Blocks get their samples as they are first
    /// drawn to.
    void reset(const PixelRect& rect, SampleOffset offset, const Viewport& viewport);

    /// Draws a triangle. `whole` is asked for what it is a part of where snapping has a say.
    void draw(const DrawTriangle& triangle, const WholeTriangles& whole);
    void draw(const Patch& patch);
    void draw(std::span<const Fragment> fragments);
    /// One sample: `x` and `y` are the pixel's.
    void draw(int x, int y, std::uint32_t id, float nearness) { keep_one(place(x, y), id, nearness, false); }

    const PixelRect& rect() const { return rect_; }
    SampleOffset offset() const { return offset_; }
    /// kNoTriangle where nothing is seen.
    std::uint32_t id(int x, int y) const {
        const std::uint32_t at = place(x, y);
        return drawn(at / kBlockSamples) ? static_cast<std::uint32_t>(ids_[at]) : kNoTriangle;
    }
    float nearness(int x, int y) const {
        const std::uint32_t at = place(x, y);
        return drawn(at / kBlockSamples) ? nearness_[at] : 0;
    }
    std::uint32_t place(int x, int y) const {
        return place_in_tile(static_cast<std::uint32_t>(x - rect_.x0), static_cast<std::uint32_t>(y - rect_.y0));
    }
    /// Empties the samples of blocks that were not drawn to.
    void empty_undrawn();
    /// The same by place, for who walks along strips: of blocks drawn to, or after empty_undrawn() of all.
    const std::int32_t* ids() const { return ids_.data(); }
    const float* nearness() const { return nearness_.data(); }
    /// A bit for each sample of the strip that begins at a place that lies in the unsnapped triangle it sees (edge_margins).
    std::uint32_t inside(std::size_t place) const { return inside_[place / kStrip]; }
    /// Whether any sample of the block may see something.
    bool drawn(std::size_t block) const { return drawn_[block]; }

    static constexpr int kBlock = 8;
    static constexpr int kBlocks = TileGrid::kTileSize / kBlock; ///< along a side
    static_assert(kBlocks <= static_cast<int>(kStrip) && kBlocks % Floats::size == 0);
    static constexpr int kStripRows = kStrip / kStripWidth;

private:
    struct Edges;
    struct BlockRow;
    template <std::size_t kSide> struct Nearness;
    struct Covered;
    std::uint32_t not_hidden(int row, float nearest) const;
    void draw_block(const DrawTriangle& triangle, const WholeTriangles& whole, std::size_t block, const Covered& covered, Vec2d first);
    template <typename NearnessAt>
    void draw_strip(std::size_t block, std::size_t first, std::uint64_t samples, std::uint32_t id, const NearnessAt& nearness_at);
    template <typename Lanes> void keep_nearest(std::size_t place, std::int32_t id, const Floats& nearness, const Lanes& lanes);
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
    std::array<std::uint16_t, kTileSamples / kStrip> inside_; ///< a strip each
    alignas(64) std::array<float, kBlocks * kBlocks> farthest_;        ///< of a block: no sample is farther
    std::array<std::uint8_t, kBlocks * kBlocks> partial_;  ///< times drawn to since that was found
    std::array<bool, kBlocks * kBlocks> drawn_;
};

} // namespace duet::raster

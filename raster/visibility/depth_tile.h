// Implements stage 6, which determines the visible triangle of each sample of a tile.
#pragma once

#include "raster/geometry/batch.h"
#include "raster/geometry/packet.h"
#include "raster/geometry/triangles.h"

#include <array>
#include <span>

namespace duet::raster {

/// Holds the depth buffer of a tile, one sample per pixel: reversed depth and the id of the visible primitive.
///
/// Reversed depth (`reversed_depth`) is near / depth, in (0, 1], as a float. Its relative error is 2^-24 at any depth,
/// like that of Hit::t, and no precision is lost to a far plane. At equal depth the lower id wins, so the result does
/// not depend on the drawing order.
///
/// Samples are stored in blocks of 8 × 8 (tile_sample_index). Each block has a bound of its farthest sample; primitives
/// entirely behind it are culled (Greene, Kass and Miller 1993, "Hierarchical Z-Buffer Visibility", with two levels).
class DepthTile {
public:
    DepthTile() {} // members are uninitialized until reset()

    /// Clears the tile and sets its rectangle, at most TileGrid::kTileSize pixels per side. The samples of a block
    /// are initialized when it is first drawn to.
    void reset(const PixelRect& rect, SampleOffset offset, const Viewport& viewport);

    /// Draws a triangle. `whole` gives access to the unsnapped, unclipped triangle, which is needed for samples
    /// near edges.
    void draw(const DrawTriangle& triangle, const UnclippedTriangles& whole);
    /// Draws a small triangle's coverage mask, with its depth plane.
    void draw(const CoverageMask& mask);
    /// Draws single samples.
    void draw(std::span<const Fragment> fragments);
    /// Draws one sample of pixel (x, y).
    void draw(int x, int y, std::uint32_t id, float reversed_depth) {
        depth_test_sample(sample_index(x, y), id, reversed_depth);
    }

    const PixelRect& rect() const { return rect_; }
    SampleOffset offset() const { return offset_; }
    /// Returns the id of the visible primitive; kNoTriangle if there is none.
    std::uint32_t id(int x, int y) const {
        const std::uint32_t at = sample_index(x, y);
        return drawn(at / kBlockSamples) ? static_cast<std::uint32_t>(ids_[at]) : kNoTriangle;
    }
    /// Returns the reversed depth, near / depth; 0 if no primitive is visible.
    float reversed_depth(int x, int y) const {
        const std::uint32_t at = sample_index(x, y);
        return drawn(at / kBlockSamples) ? reversed_depth_[at] : 0;
    }
    /// Returns the index at which pixel (x, y) is stored.
    std::uint32_t sample_index(int x, int y) const {
        return tile_sample_index(static_cast<std::uint32_t>(x - rect_.x0), static_cast<std::uint32_t>(y - rect_.y0));
    }
    /// Clears the samples of blocks that were not drawn to.
    void clear_undrawn();
    /// The arrays are in storage order. They are valid in blocks drawn to, and everywhere after clear_undrawn().
    const std::int32_t* ids() const { return ids_.data(); }
    const float* reversed_depth() const { return reversed_depth_.data(); }
    /// Returns true if any sample of the block was drawn to.
    bool drawn(std::size_t block) const { return drawn_[block]; }

    static constexpr int kBlock = 8;
    static constexpr int kBlocks = TileGrid::kTileSize / kBlock; ///< blocks per side
    static_assert(kBlocks <= static_cast<int>(kPacketSize) && kBlocks % Floats::size == 0);
    static constexpr int kPacketRows = kPacketSize / kPacketWidth;

private:
    struct TileEdges;
    struct BlockRow;
    template <std::size_t kSide> struct DepthEvaluator;
    struct BlockCoverage;
    std::uint32_t unoccluded_blocks(int row, float nearest) const;
    void draw_block(const DrawTriangle& triangle, const UnclippedTriangles& whole, std::size_t block,
                    const BlockCoverage& covered, Vec2d first);
    template <typename DepthAt>
    void draw_packet(std::size_t block, std::size_t first, std::uint64_t samples, std::uint32_t id,
                     const DepthAt& depth_at);
    template <typename Lanes>
    void depth_test_batch(std::size_t sample_index, std::int32_t id, const Floats& reversed_depth, const Lanes& lanes);
    void draw_edge_samples(const DrawTriangle& triangle, const UnclippedTriangles& whole, std::size_t block,
                           std::uint64_t samples);
    void depth_test_sample(std::size_t sample_index, std::uint32_t id, float reversed_depth);
    void update_farthest(std::size_t block);
    void clear_block(std::size_t block);
    void begin_block(std::size_t block) {
        if (!drawn_[block]) clear_block(block);
        drawn_[block] = true;
    }

    PixelRect rect_;
    SampleOffset offset_;
    Viewport viewport_;
    alignas(64) std::array<float, kTileSamples> reversed_depth_;
    alignas(64) std::array<std::int32_t, kTileSamples> ids_;
    /// No sample of a block has less reversed depth than its bound.
    alignas(64) std::array<float, kBlocks * kBlocks> farthest_;
    std::array<std::uint8_t, kBlocks * kBlocks>
        draws_since_farthest_; ///< number of draws since `farthest_` was computed
    std::array<bool, kBlocks * kBlocks> drawn_;
};

} // namespace duet::raster

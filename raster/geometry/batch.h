// Defines the output of assembly for a run of triangles: setup triangles, coverage masks and fragments, sorted by
// tile.
#pragma once

#include "raster/geometry/cull.h"
#include "raster/geometry/setup.h"
#include "raster/geometry/tiles.h"

#include <cstdint>
#include <span>
#include <vector>

namespace duet::raster {

/// Represents a covered sample of a triangle that is too small for tile-by-tile rasterization.
struct Fragment {
    std::uint32_t id = 0;
    float reversed_depth = 0;
    std::uint16_t sample_index = 0; ///< pixel index in the tile, see tile_sample_index
    std::uint16_t tile = 0;
};
static_assert(sizeof(Fragment) == 12 && TileGrid::kTileSize * TileGrid::kTileSize <= 1 << 16);

/// Stores the coverage mask of a triangle that fits into a box of 8 × 8 samples.
struct CoverageMask {
    std::uint64_t samples = 0; ///< one bit per sample of the box, row by row
    DepthPlane depth_plane;    ///< valid at these samples; relative to the box's first sample
    std::uint32_t id = 0;
    std::int32_t x = 0, y = 0; ///< first pixel of the box
};

/// Returns the index at which a tile stores a pixel. x and y are relative to the tile's corner. Pixels are stored
/// in blocks of 8 × 8, row by row in each block.
inline std::uint32_t tile_sample_index(std::uint32_t x, std::uint32_t y) {
    return ((y >> 3) * (TileGrid::kTileSize / 8) + (x >> 3)) * 64 + (y & 7) * 8 + (x & 7);
}

inline constexpr std::size_t kBlockSamples = 64, kTileSamples = TileGrid::kTileSize * TileGrid::kTileSize;
/// Returns the x coordinate in the tile of a pixel index; the inverse of tile_sample_index.
inline int tile_sample_x(std::size_t sample_index) {
    return static_cast<int>(sample_index / kBlockSamples % (TileGrid::kTileSize / 8) * 8 + sample_index % 8);
}
/// Returns the y coordinate in the tile of a pixel index.
inline int tile_sample_y(std::size_t sample_index) {
    return static_cast<int>(sample_index / kBlockSamples / (TileGrid::kTileSize / 8) * 8 + sample_index / 8 % 8);
}

/// Stores the range of a list's items that belong to one tile.
struct Segment {
    std::uint32_t tile = 0, first = 0, count = 0;
};

/// Stores the results of one run, each list sorted by tile.
struct Batch {
    std::vector<DrawTriangle> triangles;
    std::vector<std::uint32_t> order;         ///< indices of triangles, sorted by tile
    std::vector<Segment> triangle_segments;   ///< segments of `order`
    std::vector<CoverageMask> coverage_masks;
    std::vector<std::uint32_t> mask_order;    ///< indices of coverage_masks, sorted by tile
    std::vector<Segment> mask_segments;       ///< segments of `mask_order`
    std::vector<Fragment> fragments;          ///< sorted by tile
    std::vector<Segment> fragment_segments;   ///< segments of `fragments`
    CullCounts culled;

    /// Empties all lists, and keeps their memory.
    void clear();
    std::size_t memory_bytes() const;
};

/// Sorts the items of a batch by tile. The sort is stable, and the memory is reused by later calls.
class TileSorter {
public:
    /// Records that an item, given by its index in batch.triangles or batch.coverage_masks, overlaps a tile.
    struct TileOverlap {
        std::uint32_t tile, item;
    };
    /// `triangles` and `coverage_masks` are in the order of their items.
    void sort(Batch& batch, const std::vector<TileOverlap>& triangles, const std::vector<TileOverlap>& coverage_masks,
              std::size_t tiles);

private:
    void sort(const std::vector<TileOverlap>& overlaps, std::vector<Segment>& segments,
              std::vector<std::uint32_t>& order);
    template <typename Item, typename TileOf, typename Put>
    void distribute(std::span<const Item> items, const TileOf& tile_of, std::vector<Segment>& segments, const Put& put);

    std::vector<std::uint32_t> counts_;    ///< one per tile; all 0 between calls
    std::vector<Fragment> unsorted_;
};

} // namespace duet::raster

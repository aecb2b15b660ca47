// What a run of triangles comes to: outlines to be drawn, and finished samples, sorted by tile.
#pragma once

#include "raster/geometry/cull.h"
#include "raster/geometry/setup.h"
#include "raster/geometry/tiles.h"

#include <cstdint>
#include <span>
#include <vector>

namespace duet::raster {

/// A covered sample of a triangle so small that it was not worth drawing tile by tile.
struct Fragment {
    std::uint32_t id = 0;
    float nearness = 0;
    std::uint16_t place : 15 = 0; ///< in its tile: place_in_tile
    std::uint16_t inside : 1 = 0; ///< well inside the triangle (edge_margins)
    std::uint16_t tile = 0;
};
static_assert(sizeof(Fragment) == 12 && TileGrid::kTileSize * TileGrid::kTileSize <= 1 << 15);

/// Samples of a triangle so small that a box of 8 × 8 has them all.
struct Patch {
    std::uint64_t samples = 0; ///< a bit for each of the box, row by row
    NearnessPlane nearness;    ///< holds there; counted from the box's first sample
    std::uint32_t id = 0;
    std::int32_t x = 0, y = 0; ///< the box's first pixel
};

/// Where a tile keeps a pixel, both counted from its corner: by blocks of 8 × 8 pixels, row by row in each.
inline std::uint32_t place_in_tile(std::uint32_t x, std::uint32_t y) {
    return ((y >> 3) * (TileGrid::kTileSize / 8) + (x >> 3)) * 64 + (y & 7) * 8 + (x & 7);
}

inline constexpr std::size_t kBlockSamples = 64, kTileSamples = TileGrid::kTileSize * TileGrid::kTileSize;
/// The way back: a place's pixel.
inline int place_x(std::size_t place) {
    return static_cast<int>(place / kBlockSamples % (TileGrid::kTileSize / 8) * 8 + place % 8);
}
inline int place_y(std::size_t place) {
    return static_cast<int>(place / kBlockSamples / (TileGrid::kTileSize / 8) * 8 + place / 8 % 8);
}

/// Those items of a list that a tile has, one after the other.
struct Segment {
    std::uint32_t tile = 0, first = 0, count = 0;
};

struct Batch {
    std::vector<DrawTriangle> triangles;
    std::vector<std::uint32_t> order;         ///< indices of triangles, tile by tile
    std::vector<Segment> triangle_segments;   ///< of `order`
    std::vector<Patch> patches;
    std::vector<std::uint32_t> patch_order;   ///< and of patches
    std::vector<Segment> patch_segments;      ///< of `patch_order`
    std::vector<Fragment> fragments;          ///< tile by tile
    std::vector<Segment> fragment_segments;   ///< of `fragments`
    CullCounts culled;

    void clear();
    std::size_t memory_bytes() const;
};

/// Sorts a batch's items by tile, in their order within each. Keeps memory for the next.
class TileSorter {
public:
    /// An item, by its index in batch.triangles or batch.patches, may be seen in a tile.
    struct Touch {
        std::uint32_t tile, item;
    };
    /// `triangles` and `patches` in order.
    void sort(Batch& batch, const std::vector<Touch>& triangles, const std::vector<Touch>& patches, std::size_t tiles);

private:
    void sort(const std::vector<Touch>& touches, std::vector<Segment>& segments, std::vector<std::uint32_t>& order);
    template <typename Item, typename TileOf, typename Place>
    void distribute(std::span<const Item> items, const TileOf& tile_of, std::vector<Segment>& segments,
                    const Place& place);

    std::vector<std::uint32_t> counts_;    ///< a tile each; all 0 between calls
    std::vector<Fragment> unsorted_;
};

} // namespace duet::raster

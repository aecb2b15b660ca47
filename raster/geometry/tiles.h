// Defines the division of the image into tiles.
#pragma once

#include <algorithm>
#include <cstddef>

namespace duet::raster {

/// Represents a rectangle of pixels by half-open ranges.
struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    bool empty() const { return x0 >= x1 || y0 >= y1; }
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};
/// Returns the pixels that are in both, which may be none.
inline PixelRect intersect(const PixelRect& a, const PixelRect& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// Represents square tiles over a region of the image, row by row. Those at the right and lower edges may be smaller.
struct TileGrid {
    /// The depths and triangle ids of a tile fit into the L2 cache. Smaller tiles that fit into L1 are slower: more
    /// triangles overlap several tiles, and the work per tile is shared by fewer samples.
    static constexpr int kTileSize = 128;
    PixelRect region;

    int columns() const { return (region.width() + kTileSize - 1) / kTileSize; }
    int rows() const { return (region.height() + kTileSize - 1) / kTileSize; }
    std::size_t size() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
    PixelRect tile(std::size_t index) const {
        const int x = region.x0 + static_cast<int>(index) % columns() * kTileSize;
        const int y = region.y0 + static_cast<int>(index) / columns() * kTileSize;
        return intersect({x, y, x + kTileSize, y + kTileSize}, region);
    }
    /// Calls visit(index) for each tile that the rectangle overlaps, row by row.
    template <typename Visit> void for_each(const PixelRect& bounds, const Visit& visit) const {
        const PixelRect r = intersect(bounds, region);
        if (r.empty()) return;
        const int first_column = (r.x0 - region.x0) / kTileSize, last_column = (r.x1 - 1 - region.x0) / kTileSize;
        const int first_row = (r.y0 - region.y0) / kTileSize, last_row = (r.y1 - 1 - region.y0) / kTileSize;
        for (int row = first_row; row <= last_row; ++row)
            for (int column = first_column; column <= last_column; ++column)
                visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns()) +
                      static_cast<std::size_t>(column));
    }
};

} // namespace duet::raster

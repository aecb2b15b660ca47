// Copies the blocks of a tile to an image with stores that bypass the caches.
#pragma once

#include "common/image/image.h"
#include "raster/visibility/depth_tile.h"

#include <algorithm>
#include <array>

namespace duet::raster {

inline constexpr int kBlock = DepthTile::kBlock;

/// Copies a row of a tile's blocks to the image, from pixel row y on. row_of(block, row) returns the address of eight
/// pixels of a block. Whole cache lines are written with non-temporal stores, because a frame does not fit into the
/// caches.
template <typename Pixel, typename RowOf>
void copy_blocks(const PixelRect& rect, int y, const RowOf& row_of, Image<Pixel>& image) {
    static_assert(2 * kBlock * sizeof(Pixel) == 64);
    for (int row = 0; row < std::min(kBlock, rect.y1 - y); ++row) {
        Pixel* to = &image(rect.x0, y + row);
        const auto block = [&](int column) {
            return row_of(static_cast<std::size_t>(column), static_cast<std::size_t>(row));
        };
        int column = 0, left = rect.width();
        if (is_line_start(to))
            for (; left >= 2 * kBlock; left -= 2 * kBlock, column += 2)
                stream_line(block(column), block(column + 1), to + column * kBlock);
        for (; left >= kBlock; left -= kBlock, ++column) std::copy_n(block(column), kBlock, to + column * kBlock);
        if (left > 0) std::copy_n(block(column), left, to + column * kBlock);
    }
}

/// Fills the pixels of an empty tile.
template <typename Pixel> void fill(const PixelRect& rect, const Pixel& pixel, Image<Pixel>& image) {
    std::array<Pixel, kBlock> eight;
    eight.fill(pixel);
    for (int y = rect.y0; y < rect.y1; y += kBlock)
        copy_blocks(
            rect, y, [&](std::size_t, std::size_t) { return eight.data(); }, image);
    finish_streams();
}

} // namespace duet::raster

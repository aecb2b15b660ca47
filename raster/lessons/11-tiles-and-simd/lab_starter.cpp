// Your tiles. Write the functions from the top down: the last one needs the others.
#include "raster/lessons/11-tiles-and-simd/lab.h"

namespace duet::lab {

Edge make_edge(GridPoint from, GridPoint to) {
    not_attempted(); // Remove this line when you start.
    // The edge function of lesson 02 at the center of pixel (0, 0) gives c. Compute it in 64 bits. A shift to the right
    // by 8 divides by 256 and rounds down; a division rounds toward zero.
    return {from.y - to.y, to.x - from.x, 0};
}

std::vector<int> values_along_row(Edge edge, int x, int y, int count) {
    not_attempted(); // Remove this line when you start.
    (void)edge, (void)x, (void)y;
    return std::vector<int>(static_cast<std::size_t>(count), 0);
}

Tile test_tile(const Edges& edges, int x, int y, int size) {
    not_attempted(); // Remove this line when you start.
    (void)edges, (void)x, (void)y, (void)size;
    // Which corner of the tile has the greatest value of an edge? Look at the signs of a and b.
    return Tile::kPartial;
}

int mask_of_eight(const Edges& edges, int x, int y) {
    not_attempted(); // Remove this line when you start.
    (void)edges, (void)x, (void)y;
    return 0;
}

Image<int> cover(const std::array<GridPoint, 3>& corners, int width, int height) {
    not_attempted(); // Remove this line when you start.
    // For now the box around the triangle is filled. Visit its tiles instead.
    Image<int> image(width, height, 0);
    int x0 = width, y0 = height, x1 = 0, y1 = 0;
    for (const GridPoint& p : corners) {
        x0 = std::min(x0, p.x / 256), y0 = std::min(y0, p.y / 256);
        x1 = std::max(x1, p.x / 256), y1 = std::max(y1, p.y / 256);
    }
    for (int y = y0; y <= std::min(y1, height - 1); ++y)
        for (int x = x0; x <= std::min(x1, width - 1); ++x) image(x, y) = 1;
    return image;
}

} // namespace duet::lab

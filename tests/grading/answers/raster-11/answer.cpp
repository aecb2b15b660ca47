// Tiles of 8 × 8 pixels, masks of 8 pixels, steps along rows.
#include "raster/lessons/11-tiles-and-simd/lab.h"

#include <algorithm>

namespace duet::lab {

Edge make_edge(GridPoint from, GridPoint to) {
    const std::int64_t dx = std::int64_t{to.x} - from.x, dy = std::int64_t{to.y} - from.y;
    std::int64_t w = dx * (128 - from.y) - dy * (128 - from.x);
    const bool left_or_top = dy < 0 || (dy == 0 && dx > 0);
    if (!left_or_top) w -= 1;
    return {static_cast<int>(-dy), static_cast<int>(dx), static_cast<int>(w >> 8)};
}

std::vector<int> values_along_row(Edge edge, int x, int y, int count) {
    std::vector<int> values;
    int value = edge.a * x + edge.b * y + edge.c;
    for (int i = 0; i < count; ++i) {
        values.push_back(value);
        value += edge.a;
    }
    return values;
}

Tile test_tile(const Edges& edges, int x, int y, int size) {
    bool inside = true;
    for (const Edge& edge : edges) {
        const int last = size - 1;
        const int best_x = edge.a > 0 ? x + last : x, best_y = edge.b > 0 ? y + last : y;
        const int worst_x = edge.a > 0 ? x : x + last, worst_y = edge.b > 0 ? y : y + last;
        if (edge.a * best_x + edge.b * best_y + edge.c < 0) return Tile::kOutside;
        if (edge.a * worst_x + edge.b * worst_y + edge.c < 0) inside = false;
    }
    return inside ? Tile::kInside : Tile::kPartial;
}

int mask_of_eight(const Edges& edges, int x, int y) {
    int mask = 0xff;
    for (const Edge& edge : edges) {
        const std::vector<int> values = values_along_row(edge, x, y, 8);
        for (int i = 0; i < 8; ++i)
            if (values[static_cast<std::size_t>(i)] < 0) mask &= ~(1 << i);
    }
    return mask;
}

Image<int> cover(const std::array<GridPoint, 3>& corners, int width, int height) {
    const auto& [a, b, c] = corners;
    const Edges edges{make_edge(a, b), make_edge(b, c), make_edge(c, a)};
    const int x0 = std::min({a.x, b.x, c.x}) / 256 / 8 * 8, x1 = std::max({a.x, b.x, c.x}) / 256;
    const int y0 = std::min({a.y, b.y, c.y}) / 256 / 8 * 8, y1 = std::max({a.y, b.y, c.y}) / 256;
    Image<int> image(width, height, 0);
    for (int y = y0; y <= y1 && y < height; y += 8)
        for (int x = x0; x <= x1 && x < width; x += 8) {
            const Tile tile = test_tile(edges, x, y, 8);
            if (tile == Tile::kOutside) continue;
            for (int j = y; j < std::min(y + 8, height); ++j) {
                const int mask = tile == Tile::kInside ? 0xff : mask_of_eight(edges, x, j);
                for (int i = 0; i < std::min(8, width - x); ++i)
                    if (mask >> i & 1) image(x + i, j) = 1;
            }
        }
    return image;
}

} // namespace duet::lab

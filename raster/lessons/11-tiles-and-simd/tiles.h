// Edges as whole numbers of 32 bits, and what is known of a whole tile of pixels.
#pragma once

#include "raster/lessons/02-triangles/triangle.h"

#include <array>

namespace duet::lesson {

/// The pixels (x, y) with a·x + b·y + c >= 0 are inside of an edge.
struct Edge {
    int a = 0, b = 0, c = 0;
    int at(int x, int y) const { return a * x + b * y + c; }
};

/// The inside of an edge as in lesson 02. 32 bits are enough where corners and pixels are in one square of 2048 pixels.
inline Edge make_edge(FixedPoint from, FixedPoint to) {
    const std::int64_t w = edge_function(from, to, pixel_center(0, 0)) - (is_top_left(from, to) ? 0 : 1);
    return {static_cast<int>(from.y - to.y), static_cast<int>(to.x - from.x), static_cast<int>(w >> 8)};
}

enum class Tile { kOutside, kPartial, kInside };
/// What is known of the size × size pixels from (x, y) on: none is in the triangle, some may be, or all are.
inline Tile test_tile(const std::array<Edge, 3>& edges, int x, int y, int size) {
    bool all = true;
    for (const Edge& edge : edges) {
        const int corner = edge.at(x, y), across = (size - 1) * edge.a, down = (size - 1) * edge.b;
        if (corner + std::max(across, 0) + std::max(down, 0) < 0) return Tile::kOutside; // the best corner is outside
        all = all && corner + std::min(across, 0) + std::min(down, 0) >= 0;              // the worst corner is inside
    }
    return all ? Tile::kInside : Tile::kPartial;
}

} // namespace duet::lesson

// Lab 11: tiles, steps and masks.
#pragma once

#include "common/image/image.h"
#include "tests/grading/lab.h"

#include <array>
#include <cstdint>
#include <vector>

namespace duet::lab {

/// A point in steps of 1/256 pixel from the upper left corner of the image; y points down. 0 to 524288 (2048 pixels).
struct GridPoint {
    std::int32_t x = 0, y = 0;
};

/// The center of pixel (x, y) is inside of the edge exactly where a·x + b·y + c >= 0.
struct Edge {
    int a = 0, b = 0, c = 0;
};
/// Of a triangle whose corners are clockwise in the image. Their order does not matter.
using Edges = std::array<Edge, 3>;

enum class Tile { kOutside, kPartial, kInside };

/// The edge between two different points, with the inside to the right of the way from the first to the second. Its
/// function is that of lesson 02, divided by 256 and rounded down: so a = from.y - to.y and b = to.x - from.x. A center
/// on the edge is inside if the edge is a left or top one. All three numbers fit into 32 bits.
Edge make_edge(GridPoint from, GridPoint to);

/// The values of a·x + b·y + c at the pixels (x, y), (x + 1, y), … (x + count - 1, y). All fit into 32 bits. Compute
/// the first, and each other from the one before it.
std::vector<int> values_along_row(Edge edge, int x, int y, int count);

/// What is known of the size × size pixels from (x, y) on: kOutside if there is an edge that has all of them outside;
/// kInside if all of them are inside of all edges; else kPartial. x and y may be any numbers from 0 to 2047, and size
/// is at most 64.
Tile test_tile(const Edges& edges, int x, int y, int size);

/// Which of eight pixels are in the triangle: bit i (of the value 1 << i) is set if pixel (x + i, y) is.
int mask_of_eight(const Edges& edges, int x, int y);

/// 1 for the pixels of a width × height image that the triangle covers, 0 for the others. Goes by tiles of 8 × 8
/// pixels. Width and height need not be multiples of 8. The corners are clockwise, and the area is not 0.
Image<int> cover(const std::array<GridPoint, 3>& corners, int width, int height);

} // namespace duet::lab

DUET_LAB(make_edge, values_along_row, test_tile, mask_of_eight, cover)

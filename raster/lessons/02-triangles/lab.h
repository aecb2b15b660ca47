// Lab 02: triangles and the fill rule.
#pragma once

#include "common/image/image.h"
#include "tests/grading/lab.h"

#include <array>
#include <cstdint>
#include <vector>

namespace duet::lab {

/// A point in steps of 1/256 pixel from the upper left corner of the picture; y points down. Coordinates are within
/// ±2^24 steps.
struct GridPoint {
    std::int32_t x = 0, y = 0;
};

/// A triangle with a color at each corner. Corners are in pixels, clockwise or counter-clockwise, and may lie up to
/// 2^15 pixels outside of the picture. Its three corners may lie on one line: then it covers nothing.
struct Triangle {
    std::array<Vec2, 3> corners;
    std::array<Rgb, 3> colors;
};

/// The grid point nearest to p, which is in pixels. Halfway between two, either.
GridPoint snap(Vec2 p);

/// (b - a) × (p - a), exact: positive where p lies to the right of the way from a to b, 0 on the line.
std::int64_t edge_function(GridPoint a, GridPoint b, GridPoint p);

/// Whether the edge from a to b of a clockwise triangle is a left or top edge. a and b differ.
bool is_top_left(GridPoint a, GridPoint b);

/// How many of the triangles cover the center of each pixel of a width × height picture. Corners are snapped first. A
/// center on an edge is covered if that is a left or top edge of the triangle.
Image<int> count_coverage(const std::vector<Triangle>& triangles, int width, int height);

/// The triangles in their order, each over those before, on the background. The color of a pixel is the mean of the
/// corners' colors, weighted by the barycentric coordinates of the pixel's center in the snapped triangle.
ImageRgb draw(const std::vector<Triangle>& triangles, int width, int height, Rgb background);

} // namespace duet::lab

DUET_LAB(snap, edge_function, is_top_left, count_coverage, draw)

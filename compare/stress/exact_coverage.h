// Which samples a triangle of the sub-pixel grid covers: by the rule's definition, in integers that cannot overflow.
#pragma once

#include "raster/geometry/transform.h"

#include <array>
#include <cstdint>

namespace duet::compare {

/// Three points of the grid, in either winding.
using GridTriangle = std::array<raster::FixedPoint, 3>;

/// Whether the triangle covers the grid point (x, y): if it holds the point after a move to the right by an infinitely
/// small step, and down by one infinitely smaller, so that no edge is ever met. This is the top-left rule without its
/// cases: of the triangles around a point exactly one holds the moved one. In 128-bit integers; a triangle without area
/// covers nothing. Shares no code with the rasterizer.
bool covers(const GridTriangle& triangle, std::int64_t x, std::int64_t y);

/// Twice the area, positive where the corners run clockwise in the picture (y points down); exact, as a sign: −1, 0, 1.
int winding(const GridTriangle& triangle);

} // namespace duet::compare

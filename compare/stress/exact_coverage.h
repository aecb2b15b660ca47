// This header declares the coverage of a triangle on the subpixel grid by the rule's definition, in integers that
// cannot overflow.
#pragma once

#include "raster/geometry/transform.h"

#include <array>
#include <cstdint>

namespace duet::compare {

/// A grid triangle has three grid points, in either winding.
using GridTriangle = std::array<raster::FixedPoint, 3>;

/// Returns whether the triangle covers the grid point (x, y). It does if it contains the point displaced to the right
/// by an infinitesimal step, and down by an infinitely smaller one, so that the point is never on an edge. This is
/// equivalent to the top-left rule without its cases: exactly one of the triangles around a point contains the
/// displaced point. It uses 128-bit integers; a triangle without area covers nothing. It shares no code with the
/// rasterizer.
bool covers(const GridTriangle& triangle, std::int64_t x, std::int64_t y);

/// Returns the sign of the exact area, −1, 0 or 1. It is positive where the corners run clockwise in the image (y
/// points down).
int winding(const GridTriangle& triangle);

} // namespace duet::compare

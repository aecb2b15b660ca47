// Stage 3: polygons cut at the near plane and the guard band.
#pragma once

#include "raster/geometry/transform.h"

#include <array>

namespace duet::raster {

/// A convex polygon in homogeneous pixel coordinates. A triangle cut by five planes has at most eight corners.
struct ClippedPolygon {
    std::array<PixelVertex, 8> vertices;
    int count = 0;
};

/// The part of a triangle at depth >= near and within the guard band; empty (count 0) where there is none. (Sutherland
/// and Hodgman 1974, «Reentrant Polygon Clipping».) A cut edge's new vertex is computed from its inner to its outer
/// end, whichever way the triangle runs: both triangles of a shared edge get the same vertex, bit for bit.
ClippedPolygon clip(const PixelVertex& a, const PixelVertex& b, const PixelVertex& c, const Viewport& viewport);

} // namespace duet::raster

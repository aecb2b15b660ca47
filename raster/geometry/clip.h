// Implements stage 3, which clips triangles at the near plane and the guard band.
#pragma once

#include "raster/geometry/transform.h"

#include <array>

namespace duet::raster {

/// Represents a convex polygon in homogeneous pixel coordinates. A triangle clipped by five planes has at most eight
/// corners.
struct ClippedPolygon {
    std::array<PixelVertex, 8> vertices;
    int count = 0;
};

/// Returns the part of a triangle at depth >= near and within the guard band; empty (count 0) if there is none.
/// (Sutherland and Hodgman 1974, "Reentrant Polygon Clipping".) The new vertex on a clipped edge is always computed
/// from the inner to the outer end, regardless of the winding. Both triangles of a shared edge thus get the same
/// vertex, bit for bit.
ClippedPolygon clip(const PixelVertex& a, const PixelVertex& b, const PixelVertex& c, const Viewport& viewport);

} // namespace duet::raster

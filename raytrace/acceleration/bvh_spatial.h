// This builder of binary trees uses spatial splits: primitives that straddle a plane are cut there and go to both
// sides.
#pragma once

#include "raytrace/acceleration/bvh_build.h"

#include <array>
#include <functional>

namespace duet::raytrace {

/// Holds the corners of a surface that fills their convex hull: 3 for a triangle, 4 for a quad, in order. `count` is
/// 0 for a primitive that must not be cut.
struct ConvexPolygon {
    std::array<Vec3, 4> corners;
    std::size_t count = 0;
};
using PolygonOf = std::function<ConvexPolygon(const BuildItem&)>;

/// Returns the box of the part of a polygon that lies inside `box` and between two planes across an axis. It
/// contains all points of that part in spite of rounding. It is empty if no part lies there.
Box3 clip(const ConvexPolygon& polygon, const Box3& box, std::size_t axis, float low, float high);

/// Builds a tree like build_binary_tree, but divides a set by a plane in space where that is cheaper by the SAH
/// (Stich, Friedrich and Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies"). An item that the plane
/// cuts becomes two items of the same index. There are at most `budget` times as many additional items as input
/// items, and a leaf has no index twice. The tree is the same for any number of threads (0 = all). Throws Error if
/// more than 2³¹ items are possible.
BinaryTree build_spatial_tree(BuildItems items, const PolygonOf& polygon_of, float budget, int threads);

} // namespace duet::raytrace

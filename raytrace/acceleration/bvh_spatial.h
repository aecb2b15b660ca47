// Building a binary tree with spatial splits: primitives that straddle a plane are cut there, and lie on both sides.
#pragma once

#include "raytrace/acceleration/bvh_build.h"

#include <array>
#include <functional>

namespace duet::raytrace {

/// The corners of a surface which fills their hull: 3 of a triangle, 4 of a quad in order. None of what may not be cut.
struct Outline {
    std::array<Vec3, 4> corners;
    std::size_t count = 0;
};
using OutlineOf = std::function<Outline(const BuildItem&)>;

/// The box of what lies of an outline inside a box, and there between two planes across an axis; it holds all points of
/// that part, whatever the rounding. Empty where nothing lies there.
Box3 clip(const Outline& outline, const Box3& box, std::size_t axis, float low, float high);

/// As build_binary_tree, but where that is cheaper by the surface area heuristic a set is divided by a plane in space
/// (Stich, Friedrich and Dietrich 2009, «Spatial Splits in Bounding Volume Hierarchies»): items cut by the plane become
/// two, of the same index. There are no more than `budget` times as many of these additional items as items at first,
/// and none twice in a leaf. The same tree for any number of threads (0: all).
BinaryTree build_spatial_tree(BuildItems items, const OutlineOf& outline_of, float budget, int threads);

} // namespace duet::raytrace

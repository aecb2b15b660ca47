// Builds a hierarchy in two steps: a binary tree of boxes by the surface area heuristic (SAH), then its collapse into
// wide nodes.
#pragma once

#include "raytrace/acceleration/bvh_items.h"

#include <functional>
#include <span>

namespace duet::raytrace {

/// This function removes duplicates from items that all have the same center: it moves the items to keep to the front
/// and returns their number. Of primitives that are equal except for their (object, primitive), only the first in that
/// order is ever a closest hit.
using RemoveDuplicates = std::function<std::size_t(std::span<BuildItem>)>;

/// Builds a binary tree over any set of boxes by the binned SAH (Wald 2007, "On fast Construction of SAH-based
/// Bounding Volume Hierarchies", §3). It takes O(n log n) time on any input, and returns the same tree for any
/// number of threads (0 = all). Each item is in one leaf, except for those that `remove_duplicates` removes, which are
/// in none. Throws Error for more than 2³¹ items.
BinaryTree build_binary_tree(BuildItems items, int threads, const RemoveDuplicates& remove_duplicates = {});

/// Names the items [first, first + count) of one leaf, and the element of their kind's list that they fill.
struct LeafItems {
    std::uint32_t first, count, element;
};

/// Holds a packed hierarchy whose blocks of primitives and instances are still to be filled, one block or instance
/// per leaf.
struct CollapsedBvh {
    Bvh bvh;
    std::vector<LeafItems> leaves;
    /// These are the expected numbers of nodes and of leaves that a ray through the root's box visits, by the SAH. The
    /// collapse minimizes node_cost.
    float node_cost = 0, leaf_cost = 0;
    std::array<std::size_t, 4> elements{}; ///< number of elements in each kind's list
};

/// Packs the tree into nodes of up to BvhNode::kWidth children, so that a ray visits as few nodes as possible
/// (Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", §3).
/// The result is the same for any number of threads (0 = all). Throws Error if there are more elements than BvhRef
/// can index.
CollapsedBvh collapse(const BinaryTree& tree, int threads);

/// Adds a list of all primitives, in full blocks, to the hierarchy of a small scene if a ray is expected to test
/// that list faster than it traverses the tree. The items of the list are appended to the tree's.
void add_list_where_faster(BinaryTree& tree, CollapsedBvh& collapsed);

} // namespace duet::raytrace

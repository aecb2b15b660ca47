// Building a hierarchy: boxes → binary tree by the surface area heuristic → wide nodes.
#pragma once

#include "raytrace/acceleration/bvh.h"

#include <functional>
#include <span>

namespace duet::raytrace {

/// A primitive as the builder sees it.
struct BuildItem {
    Box3 box; ///< finite
    std::uint32_t index;
    PrimitiveKind kind;
};
using BuildItems = std::vector<BuildItem, HugePageAllocator<BuildItem>>;

/// A node of the binary tree. A leaf covers items [first, first + count), all of one kind, at most Bvh::kMaxLeaf; an
/// inner node has two children.
struct BinaryNode {
    Box3 box;
    std::uint32_t first = 0, count = 0; ///< count 0: an inner node
    std::uint32_t left = 0, right = 0;

    bool leaf() const { return count > 0; }
};

/// Node 0 is the root; no nodes where there are no items. No deeper than Bvh::kMaxDepth.
struct BinaryTree {
    std::vector<BinaryNode> nodes;
    BuildItems items; ///< in the order of the leaves
};

/// Of items that all have one centre, moves those to the front that can be hit, and returns how many they are: of
/// primitives that are the same but for their names all but the first in order are never a ray's answer.
using DropTwins = std::function<std::size_t(std::span<BuildItem>)>;

/// The binary tree over any set of boxes, by binned surface area heuristic (Wald 2007, «On fast Construction of
/// SAH-based Bounding Volume Hierarchies», §3); O(n log n) whatever the input, and the same tree for any number of
/// threads (0: all). Without `drop_twins` each item is in one leaf; what it drops is in none.
BinaryTree build_binary_tree(BuildItems items, int threads, const DropTwins& drop_twins = {});

/// Items [first, first + count) of the tree: those of one leaf; and where in their kind's list they go.
struct LeafItems {
    std::uint32_t first, count, element;
};

/// A hierarchy whose blocks of primitives and instances are still to be filled, one a leaf.
struct Collapsed {
    Bvh bvh;
    std::vector<LeafItems> leaves;
    std::array<std::size_t, 4> elements{}; ///< how many each kind's list gets
};

/// Packs the tree into nodes of BvhNode::kWidth children (Wald, Benthin and Boulos 2008, «Getting Rid of Packets»,
/// §2.2). Throws Error where there are more than BvhRef can name.
Collapsed collapse(const BinaryTree& tree);

/// Gives the hierarchy of few primitives a list of all of them, in full blocks, where a ray is expected to be through
/// with that sooner than with the tree. The list's items are appended to the tree's.
void add_list_where_faster(BinaryTree& tree, Collapsed& collapsed);

} // namespace duet::raytrace

// Defines the primitives and the binary tree that a hierarchy is built from.
#pragma once

#include "raytrace/acceleration/bvh.h"
#include "raytrace/acceleration/bvh_bounds.h"

namespace duet::raytrace {

/// Describes a primitive to the builder. `index` is its position in the list of its kind.
struct BuildItem {
    Box3 box; ///< must be finite
    std::uint32_t index;
    PrimitiveKind kind;
};
using BuildItems = std::vector<BuildItem, HugePageAllocator<BuildItem>>;

/// Stores a node of the binary tree. A leaf covers items [first, first + count), all of one kind, at most
/// Bvh::kMaxLeaf; an inner node has two children.
struct BinaryNode {
    Box3 box;
    std::uint32_t first = 0, count = 0; ///< count is 0 in an inner node
    std::uint32_t left = 0, right = 0;

    bool leaf() const { return count > 0; }
    Bounds bounds() const;
};

inline Bounds BinaryNode::bounds() const {
    static_assert(offsetof(BinaryNode, box) == 0 && sizeof(Box3) == 6 * sizeof(float));
    const auto* numbers = reinterpret_cast<const float*>(this);
    return {Bounds::Float4::load_unaligned(numbers), Bounds::Float4::load_unaligned(numbers + 3)};
}

/// Stores a binary tree. Node 0 is the root. There are no nodes if there are no items. The depth is at most
/// Bvh::kMaxDepth.
struct BinaryTree {
    std::vector<BinaryNode> nodes;
    BuildItems items; ///< in leaf order
};

} // namespace duet::raytrace

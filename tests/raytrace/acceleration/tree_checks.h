// This header checks the invariants of a binary BVH.
#pragma once

#include "raytrace/acceleration/bvh_build.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

namespace duet::raytrace {

inline int depth_below(const BinaryTree& tree, std::uint32_t index) {
    const BinaryNode& node = tree.nodes[index];
    return node.leaf() ? 0 : 1 + std::max(depth_below(tree, node.left), depth_below(tree, node.right));
}

// Counts the leaves of each item, and checks boxes and kinds.
inline void check_tree(const BinaryTree& tree) {
    std::vector<int> seen(tree.items.size());
    for (const BinaryNode& node : tree.nodes) {
        if (!node.leaf()) {
            for (const std::uint32_t child : {node.left, node.right}) {
                REQUIRE(child < tree.nodes.size());
                CHECK(node.box.contains(tree.nodes[child].box.low));
                CHECK(node.box.contains(tree.nodes[child].box.high));
            }
            continue;
        }
        CHECK(node.count <= Bvh::kMaxLeaf);
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            ++seen[i];
            CHECK(node.box.contains(tree.items[i].box.low));
            CHECK(node.box.contains(tree.items[i].box.high));
            CHECK(tree.items[i].kind == tree.items[node.first].kind);
        }
    }
    CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
    CHECK(depth_below(tree, 0) <= Bvh::kMaxDepth);
}

inline BuildItem item_at(Vec3 low, Vec3 high, std::size_t index, PrimitiveKind kind = PrimitiveKind::kTriangle) {
    return {Box3{low, high}, static_cast<std::uint32_t>(index), kind};
}

} // namespace duet::raytrace

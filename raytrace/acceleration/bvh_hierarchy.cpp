#include "raytrace/acceleration/bvh_hierarchy.h"

#include "common/system/error.h"
#include "raytrace/acceleration/bvh_optimize.h"

namespace duet::raytrace {

namespace {

// At the default, a few nodes are moved. Most of what moving gains is gained at the top: some large subtrees in a wrong
// place (a room's walls among its furniture's, overlapping objects) cost every ray.
struct Effort {
    std::size_t one_in; // of the nodes, those of the largest areas
    int rounds;
};
constexpr Effort kFew{64, 3}, kMany{1, 4};

Hierarchy packed(BinaryTree tree, Effort effort, int threads) {
    reinsert(tree, tree.nodes.size() / effort.one_in, effort.rounds, threads);
    Collapsed collapsed = collapse(tree, threads);
    return {std::move(tree.items), std::move(collapsed)};
}

float cost(const Hierarchy& hierarchy) { return hierarchy.collapsed.node_cost + hierarchy.collapsed.leaf_cost; }

} // namespace

BvhQuality bvh_quality(std::string_view name) {
    if (name == "default") return BvhQuality::kDefault;
    if (name == "high") return BvhQuality::kHigh;
    throw Error(message("hierarchy of quality \"", name, "\": expected default or high"));
}

Hierarchy build_hierarchy(BuildItems items, const OutlineOf& outline_of, BvhQuality quality, int threads) {
    if (quality == BvhQuality::kDefault) return packed(build_binary_tree(std::move(items), threads), kFew, threads);

    BinaryTree tree = build_binary_tree(items, threads);
    Hierarchy whole = packed(std::move(tree), kMany, threads);
    // Where rays meet few leaves, as in finely tessellated meshes, cutting what is in them cannot gain much.
    constexpr float kFewLeaves = 4;
    if (whole.collapsed.leaf_cost < kFewLeaves) return whole;

    // Spatial splits buy smaller boxes with more leaves. The heuristic, which lets all rays begin and end outside, thinks
    // too well of that: walls cut into pieces are met by more rays than whole ones. So the gain must be plain.
    constexpr float kPlainly = 0.95f;
    constexpr float kBudget = 1; // no more additional items than there are items
    Hierarchy cut = packed(build_spatial_tree(std::move(items), outline_of, kBudget, threads), kMany, threads);
    return cost(cut) < kPlainly * cost(whole) ? std::move(cut) : std::move(whole);
}

} // namespace duet::raytrace

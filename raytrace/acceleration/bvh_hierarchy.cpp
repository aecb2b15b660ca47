#include "raytrace/acceleration/bvh_hierarchy.h"

#include "common/system/error.h"
#include "raytrace/acceleration/bvh_optimize.h"

namespace duet::raytrace {

namespace {

// Limits the effort spent on moving nodes (reinsertion). The default quality moves only a few nodes, because most of
// the gain is near the root: a few large, badly placed subtrees (a room's walls among its furniture, overlapping
// objects) slow down every ray.
struct Effort {
    std::size_t one_in; // the 1/one_in of all nodes with the largest areas are tried
    int rounds;
};
constexpr Effort kFew{64, 3}, kMany{1, 4};

Hierarchy packed(BinaryTree tree, Effort effort, int threads) {
    if (tree.nodes.empty()) return {};
    reinsert(tree, tree.nodes.size() / effort.one_in, effort.rounds, threads);
    Collapsed collapsed = collapse(tree, threads);
    add_list_where_faster(tree, collapsed);
    return {std::move(tree.items), std::move(collapsed)};
}

// Finds the largest number of leaves that a ray is expected to visit, by the SAH, in any subtree with at least
// 1/kFairShare of all leaves. The whole tree alone would not do, because most of its box may be empty: a thicket on
// a wide ground, for example.
class Crowding {
public:
    explicit Crowding(const BinaryTree& tree)
        : tree_(tree), area_(tree.nodes[0].bounds()), all_((tree.nodes.size() + 1) / 2) {
        visit(0);
    }
    float most() const { return most_; }

private:
    struct Leaves {
        std::size_t count;
        float area;
    };

    Leaves visit(std::uint32_t index) {
        const BinaryNode& node = tree_.nodes[index];
        const float area = area_(node.bounds());
        if (node.leaf()) return {1, area};
        const Leaves left = visit(node.left), right = visit(node.right);
        const Leaves both{left.count + right.count, left.area + right.area};
        constexpr std::size_t kFairShare = 16;
        if (both.count * kFairShare >= all_ && area > 0) most_ = max(most_, both.area / area);
        return both;
    }

    const BinaryTree& tree_;
    RelativeArea area_;
    std::size_t all_;
    float most_ = 0;
};

// Returns the items that are in leaves: all except the duplicates that were removed.
BuildItems items_of_leaves(const BinaryTree& tree) {
    BuildItems items;
    items.reserve(tree.items.size());
    for (const BinaryNode& node : tree.nodes)
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) items.push_back(tree.items[i]);
    return items;
}

float cost(const Hierarchy& hierarchy) { return hierarchy.collapsed.node_cost + hierarchy.collapsed.leaf_cost; }

} // namespace

BvhQuality bvh_quality(std::string_view name) {
    if (name == "default") return BvhQuality::kDefault;
    if (name == "high") return BvhQuality::kHigh;
    throw Error(message("hierarchy of quality \"", name, "\": expected default or high"));
}

Hierarchy build_hierarchy(BuildItems items, const Primitives& primitives, BvhQuality quality, int threads) {
    BinaryTree tree = build_binary_tree(std::move(items), threads, primitives.drop_twins);
    if (quality == BvhQuality::kDefault) return packed(std::move(tree), kFew, threads);

    // Spatial splits make boxes smaller at the price of more leaves. The SAH assumes that all rays start and end
    // outside of the scene, and so it overrates them: a wall cut into pieces is visited by more rays than a whole
    // one. Spatial splits pay off where rays visit many leaves (about a hundred in halls of beams or in hair), but
    // gain nothing in finely tessellated meshes (two to five).
    constexpr float kCrowded = 8;
    constexpr float kBudget = 1; // at most as many additional items as items
    const float crowding = tree.nodes.empty() ? 0 : Crowding(tree).most();
    if (crowding < kCrowded) return packed(std::move(tree), kMany, threads);
    BuildItems kept = items_of_leaves(tree);
    Hierarchy whole = packed(std::move(tree), kMany, threads);
    Hierarchy cut =
        packed(build_spatial_tree(std::move(kept), primitives.outline_of, kBudget, threads), kMany, threads);
    return cost(cut) < cost(whole) ? std::move(cut) : std::move(whole);
}

} // namespace duet::raytrace

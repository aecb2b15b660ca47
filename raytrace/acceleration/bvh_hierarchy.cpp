#include "raytrace/acceleration/bvh_hierarchy.h"

#include "common/system/error.h"
#include "raytrace/acceleration/bvh_reinsertion.h"

namespace duet::raytrace {

namespace {

// Limits the effort spent on moving nodes (reinsertion). The default quality moves only a few nodes, because most of
// the gain is near the root: a few large, badly placed subtrees (a room's walls among its furniture, overlapping
// objects) slow down every ray.
struct ReinsertionEffort {
    std::size_t one_in; // the 1/one_in of all nodes with the largest areas are tried
    int rounds;
};
constexpr ReinsertionEffort kDefaultEffort{64, 3}, kHighEffort{1, 4};

Hierarchy optimize_and_collapse(BinaryTree tree, ReinsertionEffort effort, int threads) {
    if (tree.nodes.empty()) return {};
    reinsert(tree, tree.nodes.size() / effort.one_in, effort.rounds, threads);
    CollapsedBvh collapsed = collapse(tree, threads);
    add_list_where_faster(tree, collapsed);
    return {std::move(tree.items), std::move(collapsed)};
}

// Finds the largest number of leaves that a ray is expected to visit, by the SAH, in any subtree with at least
// 1/kMinSubtreeShare of all leaves. The whole tree alone would not do, because most of its box may be empty: a thicket
// on a wide ground, for example.
class ExpectedLeafVisits {
public:
    explicit ExpectedLeafVisits(const BinaryTree& tree)
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
        constexpr std::size_t kMinSubtreeShare = 16;
        if (both.count * kMinSubtreeShare >= all_ && area > 0) most_ = max(most_, both.area / area);
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

Hierarchy build_hierarchy(BuildItems items, const PrimitiveQueries& primitives, BvhQuality quality, int threads) {
    BinaryTree tree = build_binary_tree(std::move(items), threads, primitives.remove_duplicates);
    if (quality == BvhQuality::kDefault) return optimize_and_collapse(std::move(tree), kDefaultEffort, threads);

    // Spatial splits make boxes smaller at the price of more leaves. The SAH assumes that all rays start and end
    // outside of the scene, and so it overrates them: a wall cut into pieces is visited by more rays than a whole
    // one. Spatial splits pay off where rays visit many leaves (about a hundred in halls of beams or in hair), but
    // gain nothing in finely tessellated meshes (two to five).
    constexpr float kMinVisits = 8;
    constexpr float kBudget = 1; // at most as many additional items as items
    const float visits = tree.nodes.empty() ? 0 : ExpectedLeafVisits(tree).most();
    if (visits < kMinVisits) return optimize_and_collapse(std::move(tree), kHighEffort, threads);
    BuildItems leaf_items = items_of_leaves(tree);
    Hierarchy object_hierarchy = optimize_and_collapse(std::move(tree), kHighEffort, threads);
    Hierarchy spatial_hierarchy = optimize_and_collapse(
        build_spatial_tree(std::move(leaf_items), primitives.polygon_of, kBudget, threads), kHighEffort, threads);
    return cost(spatial_hierarchy) < cost(object_hierarchy) ? std::move(spatial_hierarchy)
                                                            : std::move(object_hierarchy);
}

} // namespace duet::raytrace

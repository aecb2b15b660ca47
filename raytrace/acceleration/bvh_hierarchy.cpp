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
    if (tree.nodes.empty()) return {};
    reinsert(tree, tree.nodes.size() / effort.one_in, effort.rounds, threads);
    Collapsed collapsed = collapse(tree, threads);
    add_list_where_faster(tree, collapsed);
    return {std::move(tree.items), std::move(collapsed)};
}

// How many leaves a ray meets in the most crowded part of the tree that has a fair share of them, by the surface area
// heuristic. Of any part, as the whole may be mostly void: a thicket on a wide ground.
class Crowding {
public:
    explicit Crowding(const BinaryTree& tree) : tree_(tree), area_(tree.nodes[0].bounds()), all_((tree.nodes.size() + 1) / 2) {
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
        constexpr std::size_t kFairShare = 16; // one in so many
        if (both.count * kFairShare >= all_ && area > 0) most_ = max(most_, both.area / area);
        return both;
    }

    const BinaryTree& tree_;
    RelativeArea area_;
    std::size_t all_;
    float most_ = 0;
};

// All but the twins that were dropped.
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

    // Spatial splits buy smaller boxes with more leaves. The heuristic, which lets all rays begin and end outside, thinks
    // too well of that: walls cut into pieces are met by more rays than whole ones. They pay where rays meet many leaves
    // (a hundred in halls of beams or in hair, two to five in finely tessellated meshes, which gain nothing).
    constexpr float kCrowded = 8;
    constexpr float kBudget = 1; // no more additional items than there are items
    const float crowding = tree.nodes.empty() ? 0 : Crowding(tree).most();
    if (crowding < kCrowded) return packed(std::move(tree), kMany, threads);
    BuildItems kept = items_of_leaves(tree);
    Hierarchy whole = packed(std::move(tree), kMany, threads);
    Hierarchy cut = packed(build_spatial_tree(std::move(kept), primitives.outline_of, kBudget, threads), kMany, threads);
    return cost(cut) < cost(whole) ? std::move(cut) : std::move(whole);
}

} // namespace duet::raytrace

// Decides whether a ray tests all primitives of a small scene faster than it traverses a tree.
#include "raytrace/acceleration/bvh_build.h"

#include <algorithm>
#include <array>

namespace duet::raytrace {

namespace {

// These costs are in units of one test of a node's boxes, as in the SAH. They are ratios of times, measured with 8
// lanes on 2 to 64 triangles, quads, spheres and mixtures of these, small and large, in the open and in a room. On
// these scenes, the choice by these costs was the faster one or within a tenth of it.
constexpr double kNodeCost = 1;
constexpr double kLeafVisitCost = 0.48;                 // mostly a mispredicted branch
constexpr std::array kBlockTestCost{0.4, 0.88, 0.48};   // indexed by PrimitiveKind

constexpr std::size_t index_of(PrimitiveKind kind) { return static_cast<std::size_t>(kind); }
// Scenes with more items never get a list.
constexpr std::size_t kMaxItems = 128;

double half_area(const Box3& box) { return Box3d{Vec3d(box.low), Vec3d(box.high)}.half_area(); }

// Returns the expected cost to traverse the subtree below `ref` for a ray that enters its box of half area `area`,
// by the SAH.
double tree_cost(const Bvh& bvh, BvhRef ref, double area) {
    if (ref.is_leaf()) return kLeafVisitCost + kBlockTestCost[index_of(ref.kind())];
    const BvhNode& node = bvh.nodes[ref.index() / (sizeof(BvhNode) / BvhRef::kNodeUnit)];
    double cost = kNodeCost;
    for (std::size_t i = 0; i < BvhNode::kWidth; ++i) {
        const Box3 box = node.box(i);
        if (box.empty()) break;
        const double its_area = half_area(box);
        cost += tree_cost(bvh, node.children[i], its_area) * (area > 0 ? its_area / area : 1);
    }
    return cost;
}

} // namespace

void add_list_where_faster(BinaryTree& tree, CollapsedBvh& collapsed) {
    Bvh& bvh = collapsed.bvh;
    const std::size_t size = tree.items.size();
    if (bvh.nodes.empty() || size > kMaxItems) return;
    std::array<std::size_t, 4> count{};
    for (const BuildItem& item : tree.items) ++count[index_of(item.kind)];
    if (count[index_of(PrimitiveKind::kInstance)] > 0) return; // an instance's box test always pays off
    double list_cost = 0;
    for (std::size_t kind = 0; kind < kBlockTestCost.size(); ++kind)
        list_cost += static_cast<double>((count[kind] + kBlockSize - 1) / kBlockSize) * kBlockTestCost[kind];
    if (list_cost > tree_cost(bvh, BvhRef::node(0), half_area(bvh.bounds))) return;

    tree.items.reserve(2 * size);
    std::copy_n(tree.items.begin(), size, std::back_inserter(tree.items));
    const auto begin = tree.items.begin() + static_cast<std::ptrdiff_t>(size);
    std::stable_sort(begin, tree.items.end(), [](const BuildItem& a, const BuildItem& b) { return a.kind < b.kind; });
    for (auto first = begin; first != tree.items.end();) {
        const auto is_other = [&](const BuildItem& item) { return item.kind != first->kind; };
        const auto full = first + std::min<std::ptrdiff_t>(kBlockSize, tree.items.end() - first);
        const auto last = std::find_if(first, full, is_other);
        const auto element = static_cast<std::uint32_t>(collapsed.elements[index_of(first->kind)]++);
        collapsed.leaves.push_back({static_cast<std::uint32_t>(first - tree.items.begin()),
                                    static_cast<std::uint32_t>(last - first), element});
        bvh.list.push_back(BvhRef::leaf(first->kind, element));
        first = last;
    }
}

} // namespace duet::raytrace

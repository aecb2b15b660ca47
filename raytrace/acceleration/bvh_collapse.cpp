#include "raytrace/acceleration/bvh_build.h"

#include "common/system/error.h"
#include "common/system/parallel.h"

#include <algorithm>

namespace duet::raytrace {

namespace {

// Tabulates the cheapest ways to represent each binary subtree by a forest of at most n wide subtrees. Dynamic
// programming fills the table from the leaves up. The cost of a wide node is its relative area, which is the
// probability that a ray enters it. The leaves are given, and their own cost is the same for every forest.
class CollapseTable {
public:
    CollapseTable(const BinaryTree& tree, int threads)
        : tree_(tree), area_(tree.nodes[0].bounds()), table_(tree.nodes.size()) {
        // The subtrees kParallelDepth levels below the root are processed in parallel, then the levels above them.
        constexpr int kParallelDepth = 8;
        std::vector<std::uint32_t> subtrees;
        collect_subtrees(0, kParallelDepth, subtrees);
        parallel_for(subtrees.size(), threads, [&](std::size_t i) { visit(subtrees[i], Bvh::kMaxDepth); });
        visit(0, kParallelDepth);
    }

    /// node_cost() and leaf_cost() return the costs of the whole tree; see CollapsedBvh.
    float node_cost() const { return table_[0].cost[0]; }
    float leaf_cost() const { return table_[0].leaves; }

    /// Writes the roots of the wide subtrees that are a node's children, at most BvhNode::kWidth, and returns their
    /// number.
    std::size_t children(std::uint32_t node, std::array<std::uint32_t, BvhNode::kWidth>& roots) const {
        std::size_t count = 0;
        add_children(node, BvhNode::kWidth, roots, count);
        return count;
    }

private:
    static constexpr std::size_t kMaxSubtrees = BvhNode::kWidth - 1;
    // Among trees of the same cost, those with large leaves near the root are better: rays that hit such leaves end
    // earlier, which the SAH does not express. Each leaf therefore adds this fraction of its area at every level above
    // it.
    static constexpr float kLeafPenalty = 0.1f;

    struct CollapseCosts {
        std::array<float, kMaxSubtrees> cost; // cost[n - 1] is the cost with at most n wide subtrees
        float leaves;                  // sum of the leaves' relative areas
    };

    void collect_subtrees(std::uint32_t node, int depth, std::vector<std::uint32_t>& subtrees) const {
        if (depth == 0) return subtrees.push_back(node);
        if (tree_.nodes[node].leaf()) return;
        collect_subtrees(tree_.nodes[node].left, depth - 1, subtrees);
        collect_subtrees(tree_.nodes[node].right, depth - 1, subtrees);
    }

    // Fills the table down to `depth` levels below a node. Deeper levels must be filled already.
    void visit(std::uint32_t index, int depth) {
        const BinaryNode& node = tree_.nodes[index];
        if (node.leaf()) {
            table_[index].cost.fill(0);
            table_[index].leaves = area_(node.bounds());
            return;
        }
        if (depth == 0) return;
        visit(node.left, depth - 1);
        visit(node.right, depth - 1);
        const CollapseCosts &left = table_[node.left], &right = table_[node.right];
        CollapseCosts& entry = table_[index];
        entry.leaves = left.leaves + right.leaves;
        entry.cost[0] =
            area_(node.bounds()) + kLeafPenalty * entry.leaves + best_division(left, right, BvhNode::kWidth).cost;
        for (std::size_t n = 2; n <= kMaxSubtrees; ++n)
            entry.cost[n - 1] = min(entry.cost[n - 2], best_division(left, right, n).cost);
    }

    // Describes the best division of n wide subtrees among two children, of which the left child gets `left`.
    struct Division {
        float cost;
        std::size_t left;
    };
    static Division best_division(const CollapseCosts& left, const CollapseCosts& right, std::size_t n) {
        Division best{kInfinity, 1};
        for (std::size_t k = 1; k < n; ++k) {
            const float cost = left.cost[k - 1] + right.cost[n - k - 1];
            if (cost < best.cost) best = {cost, k};
        }
        return best;
    }

    void add_children(std::uint32_t index, std::size_t n, std::array<std::uint32_t, BvhNode::kWidth>& roots,
                      std::size_t& count) const {
        const BinaryNode& node = tree_.nodes[index];
        const std::size_t left = best_division(table_[node.left], table_[node.right], n).left;
        add_subtrees(node.left, left, roots, count);
        add_subtrees(node.right, n - left, roots, count);
    }
    void add_subtrees(std::uint32_t node, std::size_t n, std::array<std::uint32_t, BvhNode::kWidth>& roots,
                      std::size_t& count) const {
        const auto& cost = table_[node].cost;
        while (n > 1 && cost[n - 2] == cost[n - 1]) --n; // fewer subtrees have the same cost
        if (n == 1)
            roots[count++] = node;
        else
            add_children(node, n, roots, count);
    }

    const BinaryTree& tree_;
    RelativeArea area_;
    std::vector<CollapseCosts> table_; // indexed by node
};

class Collapser {
public:
    Collapser(const BinaryTree& tree, int threads, CollapsedBvh& result)
        : tree_(tree), table_(tree, threads), bvh_(result.bvh), leaves_(result.leaves), elements_(result.elements) {}

    BvhRef ref(std::uint32_t index) {
        const BinaryNode& node = tree_.nodes[index];
        return node.leaf() ? leaf(node.first, node.count) : BvhRef::node(pack(index));
    }
    const CollapseTable& table() const { return table_; }

private:
    // Adds one element, a block of primitives or an instance, and returns the reference to it.
    BvhRef leaf(std::uint32_t first, std::uint32_t count) {
        const PrimitiveKind kind = tree_.items[first].kind;
        const std::size_t element = elements_[static_cast<std::size_t>(kind)]++;
        check_index(element);
        leaves_.push_back({first, count, static_cast<std::uint32_t>(element)});
        bvh_.references += count;
        return BvhRef::leaf(kind, static_cast<std::uint32_t>(element));
    }

    static void check_index(std::size_t index) {
        if (index >= BvhRef::kMaxIndex) throw Error("too many primitives for a hierarchy");
    }

    std::uint32_t pack(std::uint32_t index) {
        std::array<std::uint32_t, BvhNode::kWidth> children;
        const std::size_t count = table_.children(index, children);
        // The largest child is stored last, because LargestFirst visits the children in reverse order.
        std::stable_sort(children.begin(), children.begin() + static_cast<std::ptrdiff_t>(count),
                         [&](std::uint32_t a, std::uint32_t b) {
                             return tree_.nodes[a].box.half_area() < tree_.nodes[b].box.half_area();
                         });
        check_index(bvh_.nodes.size() * (sizeof(BvhNode) / BvhRef::kNodeUnit));
        const auto packed = static_cast<std::uint32_t>(bvh_.nodes.size());
        bvh_.nodes.push_back(BvhNode{});
        for (std::size_t i = 0; i < BvhNode::kWidth; ++i) {
            const Box3 box = i < count ? tree_.nodes[children[i]].box : Box3();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                bvh_.nodes[packed].planes[axis][i] = box.low[axis];
                bvh_.nodes[packed].planes[axis + 3][i] = box.high[axis];
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            const BvhRef child = ref(children[i]); // the call may reallocate bvh_.nodes
            bvh_.nodes[packed].children[i] = child;
        }
        return packed;
    }

    const BinaryTree& tree_;
    CollapseTable table_;
    Bvh& bvh_;
    std::vector<LeafItems>& leaves_;
    std::array<std::size_t, 4>& elements_; // number of elements so far in each kind's list
};

template <typename T, typename A> std::size_t bytes(const std::vector<T, A>& v) { return v.capacity() * sizeof(T); }

} // namespace

CollapsedBvh collapse(const BinaryTree& tree, int threads) {
    CollapsedBvh result;
    if (tree.nodes.empty()) return result;
    result.bvh.bounds = tree.nodes[0].box;
    Collapser collapser(tree, threads, result);
    const BvhRef root = collapser.ref(0);
    result.node_cost = collapser.table().node_cost();
    result.leaf_cost = collapser.table().leaf_cost();
    result.bvh.nodes.shrink_to_fit();
    if (root.is_leaf()) result.bvh.list.push_back(root);
    return result;
}

std::int64_t Bvh::memory_bytes() const {
    return static_cast<std::int64_t>(bytes(nodes) + bytes(list) + bytes(triangles) + bytes(quads) + bytes(spheres) +
                                     bytes(instances));
}

} // namespace duet::raytrace

#include "raytrace/acceleration/bvh_build.h"

#include "common/system/error.h"
#include "common/system/parallel.h"

#include <algorithm>

namespace duet::raytrace {

namespace {

// Tabulates the cheapest ways to represent each binary subtree by a forest of at most n wide subtrees. Dynamic
// programming fills it from the leaves up. The cost of a wide node is its relative area, which is the probability
// that a ray enters it. The leaves are given, and their own cost is the same for every forest.
class Forests {
public:
    Forests(const BinaryTree& tree, int threads)
        : tree_(tree), area_(tree.nodes[0].bounds()), forests_(tree.nodes.size()) {
        // The subtrees kTop levels below the root are processed in parallel, then the levels above them.
        constexpr int kTop = 8;
        std::vector<std::uint32_t> subtrees;
        gather(0, kTop, subtrees);
        parallel_for(subtrees.size(), threads, [&](std::size_t i) { visit(subtrees[i], Bvh::kMaxDepth); });
        visit(0, kTop);
    }

    /// Return the costs of the whole tree; see Collapsed.
    float node_cost() const { return forests_[0].cost[0]; }
    float leaf_cost() const { return forests_[0].leaves; }

    /// Writes the roots of the wide subtrees that are a node's children, at most BvhNode::kWidth, and returns their
    /// number.
    std::size_t children(std::uint32_t node, std::array<std::uint32_t, BvhNode::kWidth>& roots) const {
        std::size_t count = 0;
        cut(node, BvhNode::kWidth, roots, count);
        return count;
    }

private:
    static constexpr std::size_t kMost = BvhNode::kWidth - 1;
    // Among forests with the same area, those with large leaves near the root are better: rays that hit such leaves
    // end earlier, which the area does not express. Each leaf therefore adds this fraction of its area at every
    // level above it.
    static constexpr float kHidden = 0.1f;

    struct Forest {
        std::array<float, kMost> cost; // cost[n - 1] is the cost as at most n wide subtrees
        float leaves;                  // sum of the leaves' relative areas
    };

    void gather(std::uint32_t node, int depth, std::vector<std::uint32_t>& subtrees) const {
        if (depth == 0) return subtrees.push_back(node);
        if (tree_.nodes[node].leaf()) return;
        gather(tree_.nodes[node].left, depth - 1, subtrees);
        gather(tree_.nodes[node].right, depth - 1, subtrees);
    }

    // Fills the table down to `depth` levels below a node. Deeper levels must be filled already.
    void visit(std::uint32_t index, int depth) {
        const BinaryNode& node = tree_.nodes[index];
        if (node.leaf()) {
            forests_[index].cost.fill(0);
            forests_[index].leaves = area_(node.bounds());
            return;
        }
        if (depth == 0) return;
        visit(node.left, depth - 1);
        visit(node.right, depth - 1);
        const Forest &left = forests_[node.left], &right = forests_[node.right];
        Forest& forest = forests_[index];
        forest.leaves = left.leaves + right.leaves;
        forest.cost[0] = area_(node.bounds()) + kHidden * forest.leaves + share(left, right, BvhNode::kWidth).cost;
        for (std::size_t n = 2; n <= kMost; ++n)
            forest.cost[n - 1] = min(forest.cost[n - 2], share(left, right, n).cost);
    }

    // Describes the best division of n wide subtrees among two children, of which the left child gets `left`.
    struct Share {
        float cost;
        std::size_t left;
    };
    static Share share(const Forest& left, const Forest& right, std::size_t n) {
        Share best{kInfinity, 1};
        for (std::size_t k = 1; k < n; ++k) {
            const float cost = left.cost[k - 1] + right.cost[n - k - 1];
            if (cost < best.cost) best = {cost, k};
        }
        return best;
    }

    void cut(std::uint32_t index, std::size_t n, std::array<std::uint32_t, BvhNode::kWidth>& roots,
             std::size_t& count) const {
        const BinaryNode& node = tree_.nodes[index];
        const std::size_t left = share(forests_[node.left], forests_[node.right], n).left;
        take(node.left, left, roots, count);
        take(node.right, n - left, roots, count);
    }
    void take(std::uint32_t node, std::size_t n, std::array<std::uint32_t, BvhNode::kWidth>& roots,
              std::size_t& count) const {
        const auto& cost = forests_[node].cost;
        while (n > 1 && cost[n - 2] == cost[n - 1]) --n; // fewer subtrees cost no more
        if (n == 1)
            roots[count++] = node;
        else
            cut(node, n, roots, count);
    }

    const BinaryTree& tree_;
    RelativeArea area_;
    std::vector<Forest> forests_; // indexed by node
};

class Collapser {
public:
    Collapser(const BinaryTree& tree, int threads, Collapsed& result)
        : tree_(tree), forests_(tree, threads), bvh_(result.bvh), leaves_(result.leaves), elements_(result.elements) {}

    BvhRef ref(std::uint32_t index) {
        const BinaryNode& node = tree_.nodes[index];
        return node.leaf() ? leaf(node.first, node.count) : BvhRef::node(pack(index));
    }
    const Forests& forests() const { return forests_; }

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
        const std::size_t count = forests_.children(index, children);
        // The largest child is stored last, because find_any visits the children in reverse order.
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
            const BvhRef child = ref(children[i]); // this may reallocate bvh_.nodes
            bvh_.nodes[packed].children[i] = child;
        }
        return packed;
    }

    const BinaryTree& tree_;
    Forests forests_;
    Bvh& bvh_;
    std::vector<LeafItems>& leaves_;
    std::array<std::size_t, 4>& elements_; // number of elements so far in each kind's list
};

template <typename T, typename A> std::size_t bytes(const std::vector<T, A>& v) { return v.capacity() * sizeof(T); }

} // namespace

Collapsed collapse(const BinaryTree& tree, int threads) {
    Collapsed result;
    if (tree.nodes.empty()) return result;
    result.bvh.bounds = tree.nodes[0].box;
    Collapser collapser(tree, threads, result);
    const BvhRef root = collapser.ref(0);
    result.node_cost = collapser.forests().node_cost();
    result.leaf_cost = collapser.forests().leaf_cost();
    result.bvh.nodes.shrink_to_fit();
    if (root.is_leaf()) result.bvh.list.push_back(root);
    return result;
}

std::int64_t Bvh::memory_bytes() const {
    return static_cast<std::int64_t>(bytes(nodes) + bytes(list) + bytes(triangles) + bytes(quads) + bytes(spheres) +
                                     bytes(instances));
}

} // namespace duet::raytrace

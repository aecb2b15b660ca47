#include "raytrace/acceleration/bvh_build.h"

#include "common/system/error.h"

#include <algorithm>
#include <cstdlib>

namespace duet::raytrace {

namespace {

class Forests {
public:
    static constexpr std::size_t kMost = BvhNode::kWidth - 1;
    explicit Forests(const BinaryTree& tree) : tree_(tree), costs_(tree.nodes.size()) {
        const float cn = getenv("CN") ? (float)atof(getenv("CN")) : 1.0f;
        const float eps = getenv("EPS") ? (float)atof(getenv("EPS")) : 0.0f;
        std::vector<float> hidden(tree.nodes.size());
        for (std::size_t i = tree.nodes.size(); i-- > 0;) {
            const BinaryNode& node = tree.nodes[i];
            const float area = node.box.half_area();
            auto& cost = costs_[i];
            if (node.leaf()) { cost.fill(area); hidden[i] = area; continue; }
            hidden[i] = hidden[node.left] + hidden[node.right];
            const auto& l = costs_[node.left]; const auto& r = costs_[node.right];
            cost[0] = cn * area + eps * hidden[i] + best(l, r, BvhNode::kWidth).first;
            for (std::size_t n = 2; n <= kMost; ++n) cost[n - 1] = min(cost[n - 2], best(l, r, n).first);
        }
    }
    void divide(std::uint32_t index, std::size_t n, std::array<std::uint32_t, BvhNode::kWidth>& trees, std::size_t& count) const {
        const BinaryNode& node = tree_.nodes[index];
        const std::size_t k = best(costs_[node.left], costs_[node.right], n).second;
        add(node.left, k, trees, count);
        add(node.right, n - k, trees, count);
    }
    double total() const { return costs_[0][0] / tree_.nodes[0].box.half_area(); }
private:
    using Costs = std::array<float, kMost>;
    static std::pair<float, std::size_t> best(const Costs& l, const Costs& r, std::size_t n) {
        float b = kInfinity; std::size_t at = 1;
        for (std::size_t k = 1; k < n; ++k) { const float c = l[k - 1] + r[n - k - 1]; if (c < b) { b = c; at = k; } }
        return {b, at};
    }
    void add(std::uint32_t index, std::size_t n, std::array<std::uint32_t, BvhNode::kWidth>& trees, std::size_t& count) const {
        const Costs& c = costs_[index];
        while (n > 1 && c[n - 2] == c[n - 1]) --n;
        if (n == 1) trees[count++] = index; else divide(index, n, trees, count);
    }
    const BinaryTree& tree_;
    std::vector<Costs> costs_;
};

class Collapser {
public:
    Collapser(const BinaryTree& tree, Collapsed& result) : tree_(tree), forest_(tree), bvh_(result.bvh), leaves_(result.leaves), elements_(result.elements) {}

    BvhRef ref(std::uint32_t index) {
        const BinaryNode& node = tree_.nodes[index];
        return node.leaf() ? leaf(node) : BvhRef::node(pack(index));
    }

private:
    BvhRef leaf(const BinaryNode& node) {
        leaves_.push_back({node.first, node.count});
        const PrimitiveKind kind = tree_.items[node.first].kind;
        const std::uint32_t elements = kind == PrimitiveKind::kTriangle ? 1 : node.count; // triangles: one block
        const std::size_t first = elements_[static_cast<std::size_t>(kind)];
        elements_[static_cast<std::size_t>(kind)] += elements;
        check_index(first + elements);
        return BvhRef::leaf(kind, static_cast<std::uint32_t>(first), elements);
    }

    static void check_index(std::size_t index) {
        if (index >= BvhRef::kMaxIndex) throw Error("too many primitives for a hierarchy");
    }

    std::uint32_t pack(std::uint32_t index) {
        std::array<std::uint32_t, BvhNode::kWidth> children;
        std::size_t count = 0;
        if (getenv("GREEDY")) {
        children = {tree_.nodes[index].left, tree_.nodes[index].right};
        count = 2;
        while (count < BvhNode::kWidth) {
            std::size_t widest = count;
            float widest_area = -1;
            for (std::size_t i = 0; i < count; ++i) {
                const BinaryNode& child = tree_.nodes[children[i]];
                if (!child.leaf() && child.box.half_area() > widest_area) {
                    widest = i;
                    widest_area = child.box.half_area();
                }
            }
            if (widest == count) break;
            const BinaryNode& opened = tree_.nodes[children[widest]];
            children[widest] = opened.left;
            children[count++] = opened.right;
        }
        } else forest_.divide(index, BvhNode::kWidth, children, count);

        std::stable_sort(children.begin(), children.begin() + static_cast<std::ptrdiff_t>(count), [&](std::uint32_t a, std::uint32_t b) {
            return tree_.nodes[a].box.half_area() > tree_.nodes[b].box.half_area();
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
            const BvhRef child = ref(children[i]); // may move the nodes
            bvh_.nodes[packed].children[i] = child;
        }
        return packed;
    }

    const BinaryTree& tree_;
    Forests forest_;
    Bvh& bvh_;
    std::vector<LeafItems>& leaves_;
    std::array<std::size_t, 4>& elements_; // so far in the list of each kind
};

template <typename T, typename A> std::size_t bytes(const std::vector<T, A>& v) { return v.capacity() * sizeof(T); }

} // namespace

Collapsed collapse(const BinaryTree& tree) {
    Collapsed result;
    if (tree.nodes.empty()) return result;
    result.bvh.bounds = tree.nodes[0].box;
    result.bvh.root = Collapser(tree, result).ref(0);
    result.bvh.nodes.shrink_to_fit();
    return result;
}

std::int64_t Bvh::memory_bytes() const {
    return static_cast<std::int64_t>(bytes(nodes) + bytes(triangles) + bytes(quads) + bytes(spheres) +
                                     bytes(instances));
}

} // namespace duet::raytrace

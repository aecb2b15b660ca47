#include "raytrace/acceleration/bvh_build.h"

#include "common/system/error.h"

#include <algorithm>

namespace duet::raytrace {

namespace {

class Collapser {
public:
    Collapser(const BinaryTree& tree, Collapsed& result) : tree_(tree), bvh_(result.bvh), leaves_(result.leaves), elements_(result.elements) {}

    BvhRef ref(std::uint32_t index) {
        const BinaryNode& node = tree_.nodes[index];
        return node.leaf() ? leaf(node.first, node.count) : BvhRef::node(pack(index));
    }

private:
    // One element: a block of primitives, or an instance.
    BvhRef leaf(std::uint32_t first, std::uint32_t count) {
        const PrimitiveKind kind = tree_.items[first].kind;
        const std::size_t element = elements_[static_cast<std::size_t>(kind)]++;
        check_index(element);
        leaves_.push_back({first, count, static_cast<std::uint32_t>(element)});
        return BvhRef::leaf(kind, static_cast<std::uint32_t>(element));
    }

    static void check_index(std::size_t index) {
        if (index >= BvhRef::kMaxIndex) throw Error("too many primitives for a hierarchy");
    }

    // A wide node takes the place of a binary one and of those below it: of its children so far the one of the largest
    // area, which a ray hits first, is replaced by its two, until the node is full.
    std::uint32_t pack(std::uint32_t index) {
        std::array<std::uint32_t, BvhNode::kWidth> children{tree_.nodes[index].left, tree_.nodes[index].right};
        std::size_t count = 2;
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
    const BvhRef root = Collapser(tree, result).ref(0);
    result.bvh.nodes.shrink_to_fit();
    if (root.is_leaf()) result.bvh.list.push_back(root);
    return result;
}

std::int64_t Bvh::memory_bytes() const {
    return static_cast<std::int64_t>(bytes(nodes) + bytes(list) + bytes(triangles) + bytes(quads) + bytes(spheres) +
                                     bytes(instances));
}

} // namespace duet::raytrace

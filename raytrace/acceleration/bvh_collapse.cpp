#include "raytrace/acceleration/bvh_build.h"

#include "common/system/error.h"

namespace duet::raytrace {

namespace {

class Collapser {
public:
    Collapser(const BinaryTree& tree, Bvh& bvh) : tree_(tree), bvh_(bvh), rank_(tree.items.size()) {
        std::array<std::uint32_t, 4> count{};
        for (std::size_t i = 0; i < tree.items.size(); ++i)
            rank_[i] = count[static_cast<std::size_t>(tree.items[i].kind)]++;
    }

    BvhRef ref(std::uint32_t index) {
        const BinaryNode& node = tree_.nodes[index];
        if (node.leaf())
            return {rank_[node.first], static_cast<std::uint16_t>(node.count), tree_.items[node.first].kind};
        return {pack(index), 0, PrimitiveKind::kTriangle};
    }

private:
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
    std::vector<std::uint32_t> rank_; // of an item among those of its kind
};

template <typename T> std::size_t bytes(const std::vector<T>& v) { return v.capacity() * sizeof(T); }

} // namespace

Bvh collapse(const BinaryTree& tree) {
    Bvh bvh;
    if (tree.nodes.empty()) return bvh;
    bvh.bounds = tree.nodes[0].box;
    bvh.root = Collapser(tree, bvh).ref(0);
    bvh.nodes.shrink_to_fit();
    return bvh;
}

std::int64_t Bvh::memory_bytes() const {
    return static_cast<std::int64_t>(bytes(nodes) + bytes(triangles) + bytes(quads) + bytes(spheres) +
                                     bytes(instances));
}

} // namespace duet::raytrace

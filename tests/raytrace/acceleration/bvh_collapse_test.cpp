// These tests check that the collapse of a binary tree costs what it says.
#include "raytrace/acceleration/bvh_build.h"
#include "tests/raytrace/acceleration/soup.h"
#include "tests/raytrace/acceleration/tree_checks.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;
using namespace duet::raytrace;

namespace {

// Returns long thin triangles in all directions.
Mesh needles(Random& random, int count, float length, float width) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
        const Vec3 p = random.vector(), way = random.direction() * length;
        for (const Vec3& q : {p, p + way, p + way * 0.5f + random.vector() * width}) mesh.positions.push_back(q);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

BuildItems items_of(const Mesh& mesh) {
    BuildItems items;
    for (const auto& [a, b, c] : mesh.triangles) {
        Box3 box;
        for (const std::uint32_t corner : {a, b, c}) box.extend(mesh.positions[corner]);
        items.push_back({box, static_cast<std::uint32_t>(items.size()), PrimitiveKind::kTriangle});
    }
    return items;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the collapse costs what it says, and no more than opening the largest child first") {
        Random random(27);
        for (int trial = 0; trial < 20; ++trial) {
            BuildItems items = items_of(needles(random, 300 + trial * 50, random.uniform(0.01f, 1), 0.05f));
            const BinaryTree tree = build_binary_tree(items, 1);
            const CollapsedBvh collapsed = collapse(tree, 3);
            const double root = static_cast<double>(tree.nodes[0].box.half_area());
            // The cost of a node is its area plus a tenth of the areas of all leaves below it.
            struct Cost {
                double nodes = 0, leaves = 0;
            };
            const auto packed = [&](const auto& self, BvhRef ref, const Box3& box) -> Cost {
                const double area = static_cast<double>(box.half_area()) / root;
                if (ref.is_leaf()) return {0, area};
                Cost sum;
                const BvhNode& node = collapsed.bvh.nodes[ref.index() / (sizeof(BvhNode) / BvhRef::kNodeUnit)];
                for (std::size_t i = 0; i < BvhNode::kWidth; ++i) {
                    const Box3 child{{node.planes[0][i], node.planes[1][i], node.planes[2][i]},
                                     {node.planes[3][i], node.planes[4][i], node.planes[5][i]}};
                    if (child.empty()) continue;
                    const Cost cost = self(self, node.children[i], child);
                    sum.nodes += cost.nodes;
                    sum.leaves += cost.leaves;
                }
                sum.nodes += area + 0.1 * sum.leaves;
                return sum;
            };
            const auto greedy = [&](const auto& self, std::uint32_t index) -> Cost {
                const double area = static_cast<double>(tree.nodes[index].box.half_area()) / root;
                if (tree.nodes[index].leaf()) return {0, area};
                std::vector<std::uint32_t> children{tree.nodes[index].left, tree.nodes[index].right};
                const auto size = [&](std::uint32_t i) {
                    return tree.nodes[i].leaf() ? -1.0f : tree.nodes[i].box.half_area();
                };
                while (children.size() < BvhNode::kWidth) {
                    const auto smaller = [&](auto a, auto b) { return size(a) < size(b); };
                    const auto largest = std::max_element(children.begin(), children.end(), smaller);
                    if (size(*largest) < 0) break;
                    const BinaryNode& opened = tree.nodes[*largest];
                    *largest = opened.left;
                    children.push_back(opened.right);
                }
                Cost sum;
                for (const std::uint32_t child : children) {
                    const Cost cost = self(self, child);
                    sum.nodes += cost.nodes;
                    sum.leaves += cost.leaves;
                }
                sum.nodes += area + 0.1 * sum.leaves;
                return sum;
            };
            const Cost cost = packed(packed, BvhRef::node(0), tree.nodes[0].box), other = greedy(greedy, 0);
            CHECK(static_cast<double>(collapsed.node_cost) == doctest::Approx(cost.nodes).epsilon(1e-4));
            CHECK(static_cast<double>(collapsed.leaf_cost) == doctest::Approx(cost.leaves).epsilon(1e-4));
            CHECK(cost.nodes <= other.nodes * 1.0001);
        }
    }
}

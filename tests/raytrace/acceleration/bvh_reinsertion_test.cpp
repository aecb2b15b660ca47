// These tests check that reinsertion and collapse never make the tree worse.
#include "raytrace/acceleration/bvh_hierarchy.h"
#include "raytrace/acceleration/bvh_reinsertion.h"
#include "tests/raytrace/acceleration/polygon_items.h"
#include "tests/raytrace/acceleration/soup.h"
#include "tests/raytrace/acceleration/tree_checks.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;
using namespace duet::raytrace;

namespace {

// Returns long thin triangles in all directions, the case that spatial splits are made for.
Mesh needles(Random& random, int count, float length, float width) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
        const Vec3 p = random.vector(), way = random.direction() * length;
        for (const Vec3& q : {p, p + way, p + way * 0.5f + random.vector() * width}) mesh.positions.push_back(q);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

// Returns the sum of the areas of all inner nodes.
double inner_areas(const BinaryTree& tree) {
    double sum = 0;
    for (const BinaryNode& node : tree.nodes) sum += node.leaf() ? 0.0 : static_cast<double>(node.box.half_area());
    return sum;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("reinsertion makes a tree cheaper and no less a tree, the same for any number of threads") {
        Random random(26);
        for (const float scale : {1e-20f, 1.0f, 1e18f}) {
            CAPTURE(scale);
            PolygonItems polygons;
            for (int i = 0; i < 20000; ++i) { // small triangles among large ones
                const float size = scale * (i % 100 == 0 ? 1.0f : 0.02f);
                const Vec3 p = random.vector() * scale;
                polygons.add({{p, p + random.vector() * size, p + random.vector() * size}, 3});
            }
            const BinaryTree before = build_binary_tree(polygons.items, 1);
            BinaryTree after = before, same = before;
            reinsert(after, after.nodes.size(), 3, 1);
            reinsert(same, same.nodes.size(), 3, 5);
            check_tree(after);
            CHECK(same_trees(after, same));
            CHECK(inner_areas(after) < 0.97 * inner_areas(before));
            CHECK(after.items.size() == before.items.size());
        }
    }

    TEST_CASE("reinsertion leaves a tree as it was where it would become too deep") {
        // The tree is a chain of nested boxes with the maximum depth. Beside it is a small box that belongs in the
        // innermost node but is paired with a distant one.
        BuildItems items;
        BinaryTree tree;
        const auto cube = [](float size) { return Box3{Vec3(-size, -size, -size), Vec3(size, size, size)}; };
        const auto leaf = [&](const Box3& box) {
            BinaryNode node;
            node.box = box;
            node.first = static_cast<std::uint32_t>(tree.items.size());
            node.count = 1;
            tree.items.push_back({box, node.first, PrimitiveKind::kTriangle});
            tree.nodes.push_back(node);
            return static_cast<std::uint32_t>(tree.nodes.size() - 1);
        };
        const auto join = [&](std::uint32_t left, std::uint32_t right, std::uint32_t into) {
            BinaryNode& node = tree.nodes[into];
            node.left = left;
            node.right = right;
            node.box = tree.nodes[left].box;
            node.box.extend(tree.nodes[right].box);
        };
        const auto inner = [&](std::uint32_t left, std::uint32_t right) {
            tree.nodes.emplace_back();
            join(left, right, static_cast<std::uint32_t>(tree.nodes.size() - 1));
            return static_cast<std::uint32_t>(tree.nodes.size() - 1);
        };
        for (const int depth : {Bvh::kMaxDepth - 1, Bvh::kMaxDepth}) {
            CAPTURE(depth);
            tree = {};
            tree.nodes.emplace_back(); // the root
            float size = 0.1f;
            std::uint32_t chain = leaf(cube(size));
            for (int d = depth - 1; d > 0; --d) chain = inner(leaf(cube(size *= 1.03f)), chain);
            Box3 far = cube(0.01f);
            far.low.x += 100;
            far.high.x += 100;
            join(chain, inner(leaf(cube(0.001f)), leaf(far)), 0);
            REQUIRE(depth_below(tree, 0) == depth);
            const BinaryTree before = tree;
            reinsert(tree, tree.nodes.size(), 1, 1);
            check_tree(tree);
            // Reinsertion moves the box only if a level is left.
            CHECK(inner_areas(tree) <= inner_areas(before));
            CHECK((inner_areas(before) - inner_areas(tree) > 1) == (depth < Bvh::kMaxDepth));
        }
    }

    TEST_CASE("the collapse costs what it says, and no more than opening the largest child first") {
        Random random(27);
        for (int trial = 0; trial < 20; ++trial) {
            PolygonItems polygons(needles(random, 300 + trial * 50, random.uniform(0.01f, 1), 0.05f));
            const BinaryTree tree = build_binary_tree(polygons.items, 1);
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

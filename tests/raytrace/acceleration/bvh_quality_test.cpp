// These tests check spatial splits: boxes contain their primitives, and the hits are unchanged.
#include "raytrace/acceleration/accelerator.h"
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

// Returns small triangles with long thin ones between them, none axis-aligned. Spatial splits pay off here.
Mesh thicket(Random& random, int count) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
        const bool is_long = i % 8 == 0;
        const Vec3 way = random.direction() * (is_long ? 2.0f : 0.02f), p = random.vector() - way * 0.5f;
        for (const Vec3& q : {p, p + way, p + way * 0.5f + random.vector() * 0.02f}) mesh.positions.push_back(q);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

// Returns a point of the polygon's convex hull. Some weights are 0, so edges and vertices are included.
Vec3d point_of(const ConvexPolygon& polygon, Random& random) {
    Vec3d sum;
    double weights = 0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const double weight = random.below(3) == 0 ? 0.0 : static_cast<double>(random.uniform(0, 1));
        sum = sum + Vec3d(polygon.corners[i]) * weight;
        weights += weight;
    }
    return weights > 0 ? sum / weights : Vec3d(polygon.corners[0]);
}

bool contains(const Box3& box, Vec3d p, double room) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(static_cast<double>(box.low[axis]) - room <= p[axis] &&
              p[axis] <= static_cast<double>(box.high[axis]) + room))
            return false;
    return true;
}

// Returns rays at the scene's vertices and at points of its triangles, along the axes with zeros of both signs, and
// random ones.
Ray hard_ray(Random& random, const Mesh& mesh, float scale, Vec3 offset, int trial) {
    const auto& t = mesh.triangles[static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size())))];
    const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    const float u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
    const Vec3 target = trial % 3 == 0 ? a : trial % 3 == 1 ? lerp(a, b, u) : a + (b - a) * u + (c - a) * v;
    Ray ray;
    ray.origin = trial % 2 ? offset + random.vector() * scale : offset + random.direction() * (scale * 4);
    ray.direction = normalize(target - ray.origin);
    if (trial % 5 == 0) {
        const auto axis = static_cast<std::size_t>(random.below(3));
        const float zero = random.below(2) ? 0.0f : -0.0f;
        ray.direction = {zero, -zero, zero};
        ray.direction[axis] = random.below(2) ? 1.0f : -1.0f;
        ray.origin = target - ray.direction * scale;
    } else if (trial % 5 == 1) { // nearly in the triangle's plane
        ray.origin = target + (b - a) * random.uniform(1, 3) + random.vector() * (1e-5f * scale);
        ray.direction = normalize(target - ray.origin);
    }
    return ray;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a clipped box holds all points of its part of a triangle or quad, and little else") {
        Random random(21);
        int inside = 0, tight = 0;
        for (int trial = 0; trial < 20000; ++trial) {
            const float scale = std::exp2(random.uniform(-40, 40));
            const Vec3 offset = random.vector() * (scale * (trial % 4 == 0 ? 1000.0f : 1.0f));
            ConvexPolygon polygon;
            polygon.count = trial % 3 == 0 ? 4 : 3;
            for (Vec3& corner : polygon.corners) corner = offset + random.vector() * scale;
            if (trial % 5 == 0) polygon.corners[1] = polygon.corners[0] + random.vector() * (1e-6f * scale); // a sliver
            if (polygon.count == 4) polygon.corners[3] = polygon.corners[0] + (polygon.corners[2] - polygon.corners[1]);
            // Every seventh polygon is flat along one axis.
            if (trial % 7 == 0) polygon.corners[2][0] = polygon.corners[1][0] = polygon.corners[0][0];
            Box3 box;
            for (std::size_t i = 0; i < polygon.count; ++i) box.extend(polygon.corners[i]);
            const auto axis = static_cast<std::size_t>(random.below(3));
            float low = lerp(box.low[axis], box.high[axis], random.uniform(-0.2f, 1)),
                  high = lerp(box.low[axis], box.high[axis], random.uniform(0, 1.2f));
            if (low > high) std::swap(low, high);
            if (trial % 11 == 0) low = polygon.corners[0][axis]; // through a vertex
            const Box3 part = clip(polygon, box, axis, low, max(low, high));
            for (int k = 0; k < 20; ++k) {
                const Vec3d p = point_of(polygon, random);
                if (!(static_cast<double>(low) <= p[axis] && p[axis] <= static_cast<double>(max(low, high)))) continue;
                ++inside;
                // The point itself has a rounding error in double precision.
                const double room = 1e-14 * (length(Vec3d(offset)) + static_cast<double>(scale));
                REQUIRE(contains(part, p, room));
            }
            if (part.empty()) continue;
            REQUIRE(box.contains(part.low));
            REQUIRE(box.contains(part.high));
            // The box must not exceed the bounds of many sampled points of the part.
            Box3 seen;
            for (int k = 0; k < 300; ++k) {
                const Vec3d p = point_of(polygon, random);
                if (static_cast<double>(low) <= p[axis] && p[axis] <= static_cast<double>(max(low, high)))
                    seen.extend(Vec3(p));
            }
            if (!seen.empty()) tight += seen.half_area() > 0.5f * part.half_area();
        }
        CHECK(inside > 50000);
        CHECK(tight > 10000);
    }

    TEST_CASE("a spatial tree: every point of every item in a leaf of it, within the budget, for any number of "
              "threads") {
        Random random(22);
        PolygonItems polygons(thicket(random, 6000));
        for (int i = 0; i < 200; ++i) { // quads and primitives that cannot be split
            const Vec3 p = random.vector();
            polygons.add({{p, p + random.vector(), {}, {}}, 0}, PrimitiveKind::kSphere);
            polygons.items.back().box = {p, p + Vec3(0.1f, 0.1f, 0.1f)};
            const Vec3 u = random.vector(), v = random.vector() * 0.1f;
            polygons.add({{p, p + u, (p + u) + v, p + v}, 4}, PrimitiveKind::kQuad);
        }
        for (const float budget : {0.0f, 0.5f, 1.0f}) {
            CAPTURE(budget);
            const BinaryTree tree = build_spatial_tree(polygons.items, polygons.of(), budget, 1);
            check_tree(tree);
            CHECK(same_trees(tree, build_spatial_tree(polygons.items, polygons.of(), budget, 5)));
            const auto first = static_cast<double>(polygons.items.size());
            CHECK(static_cast<double>(tree.items.size()) <= first * (1 + static_cast<double>(budget)));
            if (budget > 0) CHECK(static_cast<double>(tree.items.size()) > first * 1.05);
            std::vector<std::vector<Box3>> boxes(polygons.polygons.size()); // the leaf boxes of each item
            int twice = 0;
            for (const BinaryNode& node : tree.nodes)
                for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                    const BuildItem& item = tree.items[i];
                    boxes[item.index].push_back(item.box);
                    for (std::uint32_t k = node.first; k < i; ++k) twice += tree.items[k].index == item.index;
                }
            CHECK(twice == 0);
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                REQUIRE(!boxes[i].empty());
                for (int k = 0; k < 50 && polygons.polygons[i].count > 0; ++k) {
                    const Vec3d p = point_of(polygons.polygons[i], random);
                    REQUIRE(std::any_of(boxes[i].begin(), boxes[i].end(),
                                        [&](const Box3& b) { return contains(b, p, 1e-14); }));
                }
            }
        }
    }

    TEST_CASE("degenerate polygons build spatial trees quickly and not too deep") {
        Random random(23);
        std::vector<PolygonItems> sets(6);
        for (int i = 0; i < 100000; ++i) {
            const Vec3 p = random.vector();
            sets[0].add({{Vec3(-1, -1, 0), Vec3(1, -1, 0.5f), Vec3(0, 1, 1)}, 3}); // identical
            if (i % 5 != 0) continue;
            const float size = static_cast<float>(1 + i % 1000);
            sets[1].add({{p * size, p * -size, Vec3(0, 0, 0)}, 3});              // all centroids equal
            sets[2].add({{p, p, p}, 3});                                         // points
            const float far = std::exp2(random.uniform(-120, 60));
            sets[3].add({{p * far, random.vector() * far, random.vector() * far}, 3}); // over all magnitudes
            sets[4].add({{p * 1e30f, random.vector() * 1e30f, p}, 3});           // areas overflow float
            sets[5].add({{p * 1e-30f, random.vector() * 1e-30f, p * 1e-31f}, 3});
        }
        for (std::size_t i = 0; i < sets.size(); ++i) {
            CAPTURE(i);
            BinaryTree tree = build_spatial_tree(sets[i].items, sets[i].of(), 0.5f, 2);
            check_tree(tree);
            CHECK(2 * tree.items.size() <= 3 * sets[i].items.size());
            reinsert(tree, 1000, 2, 2);
            check_tree(tree);
            CHECK(collapse(tree, 2).bvh.nodes.size() <= tree.nodes.size());
        }
    }

    TEST_CASE("a hierarchy of high quality gives the hits of testing every primitive, to the bit") {
        for (const float scale : {1e-6f, 1.0f, 1e6f})
            for (const float shift : {0.0f, 30.0f}) {
                CAPTURE(scale);
                CAPTURE(shift);
                Random random(24);
                Mesh mesh = thicket(random, 3000);
                const Vec3 offset = Vec3(1, -0.5f, 0.25f) * (shift * scale);
                for (Vec3& p : mesh.positions) p = offset + p * scale;
                // The duplicates cause ties.
                for (std::size_t i = 0; i < 100; ++i) mesh.triangles.push_back(mesh.triangles[i]);
                SceneBuilder builder;
                builder.add(mesh, builder.material(Diffuse{}));
                const Scene scene = builder.finish();
                const Accelerator accelerator(scene, 2, BvhQuality::kHigh);
                // The scene must contain split triangles, so that their hits are tested.
                CHECK(accelerator.statistics().references > accelerator.primitives() * 5 / 4);
                CHECK(accelerator.statistics().references <= accelerator.primitives() * 2);
                int hits = 0, different = 0, wrong_shadows = 0;
                std::string first;
                for (int trial = 0; trial < 2000; ++trial) {
                    const Ray ray = hard_ray(random, mesh, scale, offset, trial);
                    const Hit expected = brute_force(scene, ray), found = accelerator.closest(ray);
                    hits += expected.valid();
                    if (!(expected == found) && different++ == 0)
                        first = described(found) + ", expected " + described(expected);
                    // Skip rays in a triangle's plane: the computed distance of an edge-on triangle may be in front
                    // of the triangle, so a ray that ends there may miss it.
                    if (trial % 5 == 1) continue;
                    Hit end;
                    end.t = expected.valid() ? expected.t : std::numeric_limits<float>::max();
                    wrong_shadows += accelerator.occluded(ray, end) != expected.valid();
                    if (expected.valid()) wrong_shadows += accelerator.occluded(ray, expected);
                }
                CHECK(hits > 800);
                CHECK_MESSAGE(different == 0, first);
                CHECK(wrong_shadows == 0);
            }
    }

    TEST_CASE("scenes of all kinds of primitives have the same hits at both qualities") {
        for (const float scale : {1e-6f, 1.0f, 1e6f}) {
            CAPTURE(scale);
            Soup soup{Random(25), scale, Vec3(1, -0.5f, 0.25f) * scale};
            const Scene scene = soup.scene(true);
            const Accelerator fast(scene, 2), high(scene, 2, BvhQuality::kHigh);
            int different = 0;
            for (int trial = 0; trial < 8000; ++trial) {
                const Ray ray = soup.ray(scene, trial);
                different += !(fast.closest(ray) == high.closest(ray));
            }
            CHECK(different == 0);
        }
    }

    TEST_CASE("cutting is left where it gains nothing: a finely tessellated mesh keeps its triangles whole") {
        SceneBuilder builder;
        builder.add(icosphere(5, 1, {}), builder.material(Diffuse{}));
        const Scene scene = builder.finish();
        const Accelerator accelerator(scene, 2, BvhQuality::kHigh);
        CHECK(accelerator.statistics().references == accelerator.primitives());
    }
}

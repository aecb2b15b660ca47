// These tests check that the BVH gives the same hits as testing every primitive, bit for bit, handles degenerate
// input, and never leaks rays.
#include "raytrace/acceleration/accelerator.h"
#include "raytrace/acceleration/bvh_build.h"
#include "raytrace/acceleration/bvh_traverse.h"
#include "tests/raytrace/acceleration/soup.h"
#include "tests/raytrace/acceleration/tree_checks.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace duet;
using namespace duet::raytrace;

TEST_SUITE("unit") {

    TEST_CASE("instances stand where they should 100 km from the origin, moving ones too") {
        Random random(9);
        for (int i = 0; i < 200; ++i) {
            SceneBuilder builder;
            const std::uint32_t grey = builder.material(Diffuse{});
            const std::uint32_t shape =
                builder.shape(i % 2 ? Shape(quad({-3, -3, 0}, {6, 0, 0}, {0, 6, 0})) : Shape(Sphere{{}, 1}));
            const Vec3 place = random.vector() * 1e5f;
            const Mat4 begin = translation(place) * rotation(random.direction(), random.uniform(0, 6));
            builder.place_moving(shape, grey, begin, i % 4 < 2 ? begin : translation(random.vector() * 0.3f) * begin);
            builder.place(shape, grey, translation(Vec3(-1e5f, 0, 0))); // instanced twice, so not baked
            const Scene scene = builder.finish();
            Ray ray;
            ray.time = 0.5f;
            ray.origin = place + random.direction() * 5.0f;
            ray.direction = normalize(place - ray.origin + random.direction() * 0.3f);
            const Hit hit = Accelerator(scene, 1).closest(ray);
            const Mat4d to_world(object_transform(scene.objects[0], ray.time).to_world);
            const Mat4d to_object = inverse_affine(to_world);
            const Vec3d o = transform_point(to_object, Vec3d(ray.origin)),
                        d = transform_vector(to_object, Vec3d(ray.direction));
            const double b = -dot(o, d) / dot(d, d); // the parameter closest to the center
            const double expected = i % 2 ? -o.z / d.z : b - std::sqrt((1 - length_squared(o + d * b)) / dot(d, d));
            const Vec3d p = o + d * expected;
            if (!(expected > 0) || std::abs(p.x) > 2.99 || std::abs(p.y) > 2.99) continue; // beyond the quad
            REQUIRE(hit.object == 0);
            REQUIRE(static_cast<double>(hit.t) == doctest::Approx(expected).epsilon(2e-5));
        }
    }

    TEST_CASE("the nearest hit is that of testing every primitive, to the bit") {
        for (const bool with_instances : {false, true})
            for (const float scale : {1e-6f, 1.0f, 1e6f})
                for (const float shift : {0.0f, 30.0f}) {
                    CAPTURE(with_instances);
                    CAPTURE(scale);
                    CAPTURE(shift);
                    Soup soup{Random(7), scale, Vec3(1, -0.5f, 0.25f) * (shift * scale)};
                    const Scene scene = soup.scene(with_instances);
                    const Accelerator accelerator(scene, 2);
                    int hits = 0, different = 0, wrong_shadows = 0;
                    std::string first;
                    for (int trial = 0; trial < 4000; ++trial) {
                        Ray ray = soup.ray(scene, trial);
                        const Hit expected = brute_force_hit(scene, ray), found = accelerator.closest(ray);
                        hits += expected.valid();
                        if (!(expected == found) && different++ == 0)
                            first = described(found) + ", expected " + described(expected);
                        // A shadow ray that ends at or behind the hit is occluded by the hit's primitive, unless that
                        // is the light.
                        Hit end;
                        end.t = expected.valid() ? expected.t : std::numeric_limits<float>::max();
                        wrong_shadows += accelerator.occluded(ray, end) != expected.valid();
                        if (expected.valid()) {
                            wrong_shadows += accelerator.occluded(ray, expected);
                            end.t = std::nextafter(expected.t, 0.0f);
                            wrong_shadows += accelerator.occluded(ray, end);
                        }
                    }
                    CHECK(hits > 1000);
                    CHECK_MESSAGE(different == 0, first);
                    CHECK(wrong_shadows == 0);
                }
    }

    TEST_CASE("t_min and t_max are respected: the interval is open below and closed above") {
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{});
        for (int i = 1; i <= 9; ++i) builder.add(quad({-1, -1, -static_cast<float>(i)}, {2, 0, 0}, {0, 2, 0}), grey);
        const Scene scene = builder.finish();
        const Accelerator accelerator(scene, 1);
        Ray ray{{0.25f, 0.125f, 0}, {0, 0, -1}};
        for (int i = 1; i < 9; ++i) {
            ray.t_min = static_cast<float>(i);
            ray.t_max = static_cast<float>(i + 1);
            CHECK(accelerator.closest(ray).object == static_cast<std::uint32_t>(i));
            ray.t_max = std::nextafter(ray.t_max, 0.0f);
            CHECK(!accelerator.closest(ray).valid());
        }
    }

    TEST_CASE("at equal distance the lower object and primitive win, wherever they lie in the tree") {
        Random random(3);
        for (int trial = 0; trial < 50; ++trial) {
            SceneBuilder builder;
            const std::uint32_t grey = builder.material(Diffuse{});
            // The scene has quads of many sizes in one plane, so rays enter all their boxes at the same distance.
            for (int i = 0; i < 60; ++i) {
                const float size = random.uniform(0.1f, 3);
                builder.add(quad({-size, -size, 0}, {2 * size, 0, 0}, {0, 2 * size, 0}), grey);
            }
            const Scene scene = builder.finish();
            const Accelerator accelerator(scene, 1);
            for (int k = 0; k < 50; ++k) {
                const Vec3 target(random.uniform(), random.uniform(), 0);
                const Vec3 origin = target + Vec3(random.uniform(), random.uniform(), 2);
                const Ray ray{origin, normalize(target - origin)};
                CHECK(accelerator.closest(ray) == brute_force_hit(scene, ray));
            }
        }
    }

    TEST_CASE("a closed mesh lets no ray through that is aimed at its edges and vertices") {
        for (const float radius : {1e-6f, 1.0f, 1e6f})
            for (const float shift : {0.0f, 10.0f}) {
                CAPTURE(radius);
                CAPTURE(shift);
                const Vec3 center = Vec3(0.3f, 1, -0.7f) * (shift * radius);
                const Mesh mesh = icosphere(3, radius, center);
                SceneBuilder builder;
                builder.add(mesh, builder.material(Diffuse{}));
                const Scene scene = builder.finish();
                const Accelerator accelerator(scene, 1);
                Random random(5);
                int leaks = 0;
                for (int trial = 0; trial < 6000; ++trial) {
                    const auto& t =
                        mesh.triangles[static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size())))];
                    const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]];
                    const Vec3 target = trial % 2 ? a : lerp(a, b, random.uniform(0, 1));
                    const Vec3 origin = trial % 3 ? center + random.direction() * (radius * 0.5f)
                                                  : center + random.direction() * (radius * 3);
                    // The ray starts outside and aims at the far side through the center. It must hit the near side.
                    leaks += !accelerator.closest({origin, normalize((trial % 3 ? target : center) - origin)}).valid();
                }
                CHECK(leaks == 0);
            }
    }

    TEST_CASE("a mesh far from the world's origin does not leak either") {
        const Mesh mesh = icosphere(3, 1, {1e5f, -1e5f, 1e5f});
        SceneBuilder builder;
        builder.add(mesh, builder.material(Diffuse{}));
        const Scene scene = builder.finish();
        const Accelerator accelerator(scene, 1);
        Random random(6);
        int leaks = 0;
        for (int trial = 0; trial < 6000; ++trial) {
            const auto& t =
                mesh.triangles[static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size())))];
            const Vec3 target =
                lerp(mesh.positions[t[0]], mesh.positions[t[1]], trial % 2 ? 0.0f : random.uniform(0, 1));
            const Vec3 origin = Vec3(1e5f, -1e5f, 1e5f) + random.direction() * 0.5f;
            leaks += !accelerator.closest({origin, normalize(target - origin)}).valid();
        }
        CHECK(leaks == 0);
    }

    TEST_CASE("rays without direction or with values that are not finite hit nothing and crash nothing") {
        Soup soup{Random(9), 1, {}};
        const Scene scene = soup.scene(true);
        const Accelerator accelerator(scene, 1);
        const float nan = std::numeric_limits<float>::quiet_NaN(), inf = kInfinity;
        for (const float bad : {nan, inf, -inf})
            for (std::size_t axis = 0; axis < 3; ++axis) {
                Ray ray{{0, 0, 5}, {0, 0, -1}};
                ray.direction[axis] = bad;
                CHECK(!accelerator.closest(ray).valid());
                ray = {{0, 0, 5}, {0, 0, -1}};
                ray.origin[axis] = bad;
                CHECK(!accelerator.closest(ray).valid());
            }
        CHECK(!accelerator.closest({{0, 0, 5}, {0, -0.0f, 0}}).valid());
        for (const float huge : {1.2e38f, 2e38f}) // finite, but products of it overflow
            CHECK(!accelerator.closest({{huge, huge, huge}, {0, 0, -1}}).valid());
        CHECK(!accelerator.closest({{0, 0, 0}, {1e-39f, 1e-39f, 1e-39f}}).valid());
        CHECK(!accelerator.occluded({{0, 0, 0}, {1e-39f, 1e-39f, 1e-39f}}, Hit{}));
        Ray ray{{0, 0, 5}, {0, 0, -1}};
        ray.t_max = nan;
        CHECK(!accelerator.closest(ray).valid());
    }

    TEST_CASE("a scene without objects is hit by nothing; one of a single primitive is a list") {
        const Scene nothing = SceneBuilder().finish();
        CHECK(!Accelerator(nothing, 1).closest({{0, 0, 5}, {0, 0, -1}}).valid());
        SceneBuilder builder;
        builder.add(Sphere{{0, 0, 0}, 1}, builder.material(Diffuse{}));
        const Scene scene = builder.finish();
        const Accelerator accelerator(scene, 1);
        CHECK(accelerator.world().nodes.empty());
        CHECK(accelerator.closest({{0, 0, 5}, {0, 0, -1}}).t == 4);
    }

    TEST_CASE("each primitive lies in one leaf, inside its box; kinds are not mixed; threads don't matter") {
        Random random(11);
        BuildItems items;
        for (std::size_t i = 0; i < 20000; ++i) {
            const Vec3 p = random.vector();
            items.push_back(
                item_at(p, p + Vec3(1, 1, 1) * random.uniform(0, 0.1f), i, static_cast<PrimitiveKind>(i % 4)));
        }
        const BinaryTree tree = build_binary_tree(items, 1);
        check_tree(tree);
        const BinaryTree same = build_binary_tree(items, 7);
        REQUIRE(same.items.size() == tree.items.size());
        bool equal = true;
        for (std::size_t i = 0; i < tree.items.size(); ++i) equal = equal && same.items[i].index == tree.items[i].index;
        CHECK(equal);
    }

    TEST_CASE("degenerate sets of boxes build quickly and not too deep") {
        std::vector<BuildItems> sets(7);
        Random random(13);
        for (std::size_t i = 0; i < 100000; ++i) {
            const Vec3 p = random.vector();
            const auto kind = static_cast<PrimitiveKind>(i % 3);
            sets[0].push_back(item_at({}, {}, i));                     // all at one point
            sets[1].push_back(item_at({1, 2, 3}, {4, 5, 6}, i, kind)); // identical boxes, mixed kinds
            sets[2].push_back(item_at({p.x, 0, 0}, {p.x, 0, 0}, i));   // on a line, without area
            const float far = std::exp2(random.uniform(-126, 100));
            sets[3].push_back(item_at(Vec3(far, far, far), Vec3(far, far, far), i));    // over all magnitudes
            sets[4].push_back(item_at(Vec3(-1, -1, -1) * far, Vec3(1, 1, 1) * far, i)); // nested, with one center
            sets[5].push_back(item_at({1e30f * p.x, 0, 0}, {1e30f, 1e30f, 1e30f}, i));  // areas overflow float
            sets[6].push_back(
                item_at({}, i == 0 ? Vec3(1e20f, 0, 0) : Vec3(1e-20f, 0, 0), i)); // one far from all others
        }
        for (std::size_t i = 0; i < sets.size(); ++i) {
            CAPTURE(i);
            const BinaryTree tree = build_binary_tree(sets[i], 2);
            CHECK(depth_below(tree, 0) <= Bvh::kMaxDepth);
            std::size_t leaves = 0;
            for (const BinaryNode& node : tree.nodes) leaves += node.count;
            CHECK(leaves == sets[i].size());
            CHECK(collapse(tree, 2).bvh.nodes.size() <= tree.nodes.size());
        }
    }

    TEST_CASE("a million identical triangles are one, the first") {
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{});
        Mesh mesh;
        mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, -1, 0}};
        mesh.triangles.assign(1000000, {0, 1, 2});
        mesh.triangles[1] = {2, 0, 1};
        mesh.triangles[2] = {0, 2, 1};
        mesh.triangles[3] = {3, 1, 2}; // half of the quad, with a different centroid
        builder.add(mesh, grey);
        builder.add(mesh, grey); // all again, as a second object
        const Scene scene = builder.finish();
        const Accelerator accelerator(scene, 2);
        CHECK(accelerator.world().triangles.size() <= 2);
        Random random(1);
        for (int i = 0; i < 1000; ++i) {
            const float x = random.uniform(-1.2f, 1.2f), y = random.uniform(-1.2f, 1.2f);
            const Ray ray{{x, y, 3}, {0, 0, -1}};
            const Hit hit = accelerator.closest(ray);
            const bool inside = y > -1 && std::abs(x) < (1 - y) / 2;
            CHECK(hit.valid() == inside);
            if (!inside) continue;
            CHECK(hit.object == 0);
            CHECK(hit.primitive <= 3);
            CHECK(hit.t == doctest::Approx(3));
            // A shadow ray that ends at a dropped duplicate is still occluded by the first primitive.
            CHECK(accelerator.occluded(ray, Hit{1, 77, 0, 0, hit.t}));
            CHECK_FALSE(accelerator.occluded(ray, hit));
        }
        CHECK(accelerator.primitives() == 2000000);
    }

    TEST_CASE("identical quads and identical spheres are one, the first; what differs in the last bit stays") {
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{});
        for (int i = 0; i < 2000; ++i) builder.add(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), grey);
        builder.add(quad({1, 1, 0}, {-2, 0, 0}, {0, -2, 0}), grey); // the same square with a different first vertex
        for (int i = 0; i < 2000; ++i) builder.add(Sphere{{0, 0, 0}, 0.5f}, grey);
        for (int i = 0; i < 20; ++i) builder.add(Sphere{{0, 0, 0}, std::nextafter(0.5f, 1.0f)}, grey);
        const Scene scene = builder.finish();
        const Accelerator accelerator(scene, 2);
        const auto present = [](const auto& blocks) {
            std::size_t count = 0;
            for (const auto& block : blocks)
                for (std::size_t lane = 0; lane < kBlockSize; ++lane) count += block.object[lane] != kNoObject;
            return count;
        };
        CHECK(present(accelerator.world().quads) == 2);
        CHECK(present(accelerator.world().spheres) == 2);
        Random random(41);
        for (int i = 0; i < 300; ++i) {
            const Ray ray{{random.uniform(-1.2f, 1.2f), random.uniform(-1.2f, 1.2f), 3}, {0, 0, -1}};
            const Hit hit = accelerator.closest(ray);
            REQUIRE(hit == brute_force_hit(scene, ray));
            if (!hit.valid()) continue;
            CHECK_FALSE(accelerator.occluded(ray, hit));
            CHECK(accelerator.occluded(ray, Hit{hit.object + 1, 0, 0, 0, hit.t}));
        }
    }

    TEST_CASE("a ray in the plane of flat boxes passes them without harm") {
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{});
        for (int i = 0; i < 30; ++i)
            builder.add(quad({static_cast<float>(i), 0, 0}, {0.5f, 0, 0}, {0, 0, 1}), grey); // in the plane y = 0
        builder.add(quad({40, -1, -1}, {0, 2, 0}, {0, 0, 3}), grey);
        const Scene scene = builder.finish();
        const Accelerator accelerator(scene, 1);
        for (const float zero : {0.0f, -0.0f}) {
            const Hit hit = accelerator.closest({{-1, 0, 0.5f}, {1, zero, zero}});
            CHECK(hit.object == 30);
            CHECK(hit.t == 41);
        }
    }
}

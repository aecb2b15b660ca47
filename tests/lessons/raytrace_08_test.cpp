// Lesson raytrace-08: the tree finds what the list finds, and what the library finds.
#include "raytrace/acceleration/accelerator.h"
#include "raytrace/lessons/05-diffuse/diffuse.h"
#include "raytrace/lessons/08-bvh/bvh.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;

namespace {

Vec3 random_point(lesson::Random& random, float reach) {
    const float x = random.next(), y = random.next(), z = random.next();
    return (Vec3{x, y, z} * 2.0f - Vec3{1, 1, 1}) * reach;
}

int depth(const lesson::Bvh& node) {
    int deepest = 0;
    for (const lesson::Bvh& child : node.children) deepest = std::max(deepest, 1 + depth(child));
    return deepest;
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raytrace-08: list, tree and library find the same spheres") {
        lesson::Random random(8);
        std::vector<lesson::Sphere> spheres;
        std::vector<lesson::Object> objects;
        raytrace::SceneBuilder builder;
        const auto material = builder.material(Diffuse{});
        for (std::size_t i = 0; i < 1000; ++i) {
            const lesson::Sphere sphere{random_point(random, 5), 0.1f + 0.5f * random.next()};
            const Vec3 reach = Vec3{1, 1, 1} * sphere.radius;
            spheres.push_back(sphere);
            objects.push_back({{sphere.center - reach, sphere.center + reach}, [sphere, i](const Ray& ray) {
                                   auto hit = lesson::closest_hit({sphere}, ray);
                                   if (hit) hit->index = i;
                                   return hit;
                               }});
            builder.add(Sphere{sphere.center, sphere.radius}, material);
        }
        const lesson::Bvh tree = lesson::build(objects);
        CHECK(depth(tree) == 10);
        const Scene scene = builder.finish();
        const raytrace::Accelerator library(scene, 1);
        int hits = 0, others = 0, tested = 0;
        for (int i = 0; i < 20'000; ++i) {
            const Vec3 origin = random_point(random, 8);
            Vec3 direction = normalize(random_point(random, 4) - origin);
            if (i % 8 == 0)
                direction = Vec3{0, 0, 0}, direction[static_cast<std::size_t>(i / 8 % 3)] = i % 16 ? 1.0f : -1.0f;
            const Ray ray{origin, direction};
            const auto by_list = lesson::closest_hit(spheres, ray);
            const auto by_tree = lesson::closest_hit(
                tree, ray, [&](const Box3& box, const Ray& r) { return ++tested, lesson::enter_box(box, r); });
            REQUIRE(by_list.has_value() == by_tree.has_value());
            const Hit found = library.closest(ray);
            hits += by_list.has_value();
            if (by_list) {
                REQUIRE(by_list->index == by_tree->index);
                REQUIRE(by_list->t == by_tree->t);
            }
            // The library computes in double precision, so a ray that grazes a sphere may have another answer there.
            const bool same = by_list ? found.valid() && found.object == by_list->index : !found.valid();
            others += !same;
            if (same && by_list) REQUIRE(found.t == doctest::Approx(by_list->t).epsilon(1e-3));
        }
        CHECK(hits > 10'000);
        CHECK(others <= 10);
        CHECK(tested < 20'000 * 250); // a list of 1000 would make 20 million tests
    }

    TEST_CASE("raytrace-08: a ray that is aimed at a box enters it, however flat it is") {
        lesson::Random random(80);
        for (int i = 0; i < 200'000; ++i) {
            Box3 box;
            const Vec3 corner = random_point(random, 3);
            box.extend(corner), box.extend(corner + abs(random_point(random, 2)));
            if (i % 4 > 0) box.high[static_cast<std::size_t>(i % 3)] = box.low[static_cast<std::size_t>(i % 3)];
            const float x = random.next(), y = random.next(), z = random.next();
            const Vec3 inside = box.low + (box.high - box.low) * Vec3{x, y, z} * 0.98f;
            const Vec3 origin = random_point(random, 6);
            const auto t = lesson::enter_box(box, {origin, inside - origin});
            REQUIRE(t.has_value());
            REQUIRE(*t <= 1.001f);
            Ray away{origin, origin - inside};
            if (!box.contains(origin)) REQUIRE(!lesson::enter_box(box, away).has_value());
        }
    }
}

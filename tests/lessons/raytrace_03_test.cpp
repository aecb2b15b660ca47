// Lesson raytrace-03: the nearest of three spheres by hand-computed values, and of many as the library finds it, in any
// order of the list.
#include "raytrace/acceleration/accelerator.h"
#include "raytrace/lessons/03-surfaces/surfaces.h"
#include "raytrace/lessons/04-antialiasing/sampling.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace duet;

namespace {

Vec3 random_point(lesson::Random& random, float reach) {
    const float x = random.next(), y = random.next(), z = random.next();
    return (Vec3{x, y, z} * 2.0f - Vec3{1, 1, 1}) * reach;
}

Scene scene_of(const std::vector<lesson::Sphere>& spheres) {
    raytrace::SceneBuilder builder;
    const auto material = builder.material(Diffuse{});
    for (const lesson::Sphere& sphere : spheres) builder.add(Sphere{sphere.center, sphere.radius}, material);
    return builder.finish();
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raytrace-03: the nearest of three spheres in a row is neither the first nor the last of the list") {
        const std::vector<lesson::Sphere> row{{{0, 0, -9}, 1}, {{0, 0, -3}, 1}, {{0, 0, -6}, 1}};
        const Scene scene = scene_of(row);
        const raytrace::Accelerator library(scene, 1);
        struct Known {
            float t_min, t_max, t;
            std::size_t index;
        };
        for (const Known& known :
             {Known{0, kInfinity, 2, 1}, {2.5f, kInfinity, 4, 1}, {4.5f, kInfinity, 5, 2}, {7.5f, 9, 8, 0}}) {
            CAPTURE(known.t_min);
            const Ray ray{{0, 0, 0}, {0, 0, -1}, known.t_min, known.t_max};
            const auto hit = lesson::closest_hit(row, ray);
            REQUIRE(hit);
            CHECK(hit->index == known.index);
            CHECK(hit->t == known.t);
            CHECK(hit->p == Vec3{0, 0, -known.t});
            CHECK(hit->n == Vec3{0, 0, 1});      // against the ray, from outside and from inside
            CHECK(hit->front == (known.t != 4)); // t = 4 is the back of the nearest sphere
            const Hit found = library.closest(ray);
            REQUIRE(found.valid());
            CHECK(found.object == known.index);
            CHECK(found.t == known.t);
        }
        const Ray short_ray{{0, 0, 0}, {0, 0, -1}, 0, 1.5f};
        CHECK(!lesson::closest_hit(row, short_ray));
        CHECK(!library.closest(short_ray).valid());
    }

    TEST_CASE("raytrace-03: the list finds what the library finds, in any order") {
        lesson::Random random(3);
        int hits = 0, inside = 0, others = 0;
        for (int round = 0; round < 100; ++round) {
            std::vector<lesson::Sphere> spheres;
            for (int i = 0; i < 20; ++i) spheres.push_back({random_point(random, 4), 0.2f + 1.5f * random.next()});
            const Scene scene = scene_of(spheres);
            const raytrace::Accelerator library(scene, 1);
            std::vector<lesson::Sphere> reversed(spheres.rbegin(), spheres.rend());
            for (int i = 0; i < 100; ++i) {
                const Ray ray{random_point(random, 6), random_point(random, 1)};
                if (length(ray.direction) < 0.1f) continue;
                const auto hit = lesson::closest_hit(spheres, ray), other_way = lesson::closest_hit(reversed, ray);
                REQUIRE(hit.has_value() == other_way.has_value());
                if (hit) {
                    REQUIRE(hit->t == other_way->t);
                    REQUIRE(hit->n == other_way->n);
                    REQUIRE(hit->index == spheres.size() - 1 - other_way->index);
                    REQUIRE(dot(hit->n, ray.direction) < 1e-3f);
                    ++hits, inside += !hit->front;
                }
                // The library computes in double precision, so a ray that grazes a sphere may have another answer
                // there.
                const Hit found = library.closest(ray);
                others += hit ? !(found.valid() && found.object == hit->index) : found.valid();
            }
        }
        CHECK(hits > 1'500);
        CHECK(inside > 400);
        CHECK(others <= 4);
    }
}

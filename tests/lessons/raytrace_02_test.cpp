// Lesson raytrace-02: rays whose points on the sphere were computed by hand, and random ones, by the lesson and the
// library.
#include "common/geometry/sphere.h"
#include "raytrace/lessons/02-sphere/sphere.h"
#include "raytrace/lessons/04-antialiasing/sampling.h"

#include <doctest/doctest.h>

using namespace duet;

namespace {

Vec3 random_point(lesson::Random& random, float reach) {
    const float x = random.next(), y = random.next(), z = random.next();
    return (Vec3{x, y, z} * 2.0f - Vec3{1, 1, 1}) * reach;
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raytrace-02: rays through the center, off the axis, along a tangent and past the sphere") {
        struct Known {
            float height, first, second; ///< of the ray; t of both points, 0 where there is none
        };
        // Center (0, 0, -3), radius 1, the ray from (0, h, 0) along -z: the discriminant is 1 - h², and t = 3 ± √(1 -
        // h²).
        for (const Known& known :
             {Known{0, 2, 4}, {0.6f, 2.2f, 3.8f}, {1, 3, 0}, {2, 0, 0}, {-1, 3, 0}, {-1.001f, 0, 0}}) {
            CAPTURE(known.height);
            const Ray ray{{0, known.height, 0}, {0, 0, -1}};
            const auto lesson = [](const Ray& r) { return lesson::hit_sphere({{0, 0, -3}, 1}, r); };
            const auto library = [](const Ray& r) { return intersect_sphere(r, {{0, 0, -3}, 1}); };
            for (const std::optional<float>& first : {lesson(ray), library(ray)}) {
                REQUIRE(first.has_value() == (known.first > 0));
                if (first) CHECK(*first == doctest::Approx(known.first).epsilon(1e-6));
            }
            if (known.first <= 0) continue;
            Ray rest = ray; // beyond the first point, with room for a rounding
            rest.t_min = known.first + 1e-5f;
            for (const std::optional<float>& second : {lesson(rest), library(rest)}) {
                REQUIRE(second.has_value() == (known.second > 0));
                if (second) CHECK(*second == doctest::Approx(known.second).epsilon(1e-6));
            }
        }
    }

    TEST_CASE("raytrace-02: the lesson's sphere is the library's, for random rays from outside and from inside") {
        lesson::Random random(2);
        int hits = 0, inside = 0, others = 0;
        for (int i = 0; i < 200'000; ++i) {
            const Vec3 center = random_point(random, 3), origin = random_point(random, 3);
            const float radius = 0.1f + 2 * random.next();
            const Vec3 direction =
                center + random_point(random, 1.2f * radius) - origin; // through the sphere, or past it
            const Ray ray{origin, direction};
            const auto found = lesson::hit_sphere({center, radius}, ray),
                       expected = intersect_sphere(ray, {center, radius});
            // The lesson rounds to float at each step, so a ray that grazes, or starts at the surface, may have another
            // answer.
            others += found.has_value() != expected.has_value();
            if (!found || !expected) continue;
            ++hits, inside += length(origin - center) < radius;
            others += std::abs(*found - *expected) > 1e-3f * (1 + *expected);
        }
        CHECK(hits > 100'000);
        CHECK(inside > 5'000);
        CHECK(others <= 20);
    }
}

// Lesson raytrace-10: its Cornell box has the means that two independent renderers publish, and its quads are met where
// the library's are.
#include "common/geometry/quad.h"
#include "raytrace/lessons/10-cornell-box/quads.h"
#include "tests/lessons/cornell_comparison.h"

#include <doctest/doctest.h>

using namespace duet;

namespace {

CornellComparison compare(const std::vector<lesson::Quad>& quads, int paths) {
    const lesson::Camera camera = published_camera();
    return compare_with_published(paths, [&](float x, float y, lesson::Random& random) {
        return lesson::path_color(quads, camera.ray(x, y, random), 64, random);
    });
}

} // namespace

TEST_SUITE("lesson") {

    // 100 blocks in three channels, which are not independent. For errors of a normal distribution one of 300 is
    // beyond 5 standard errors in less than one of 5000 seeds; the whole is, in one of 600 000.
    TEST_CASE("raytrace-10: the Cornell box against an independent renderer") {
        const CornellComparison right = compare(lesson::cornell_box(), 16'000);
        MESSAGE("whole ", right.whole, ", worst block ", right.block, ", standard error ", right.relative_error);
        CHECK(right.whole < 5);
        CHECK(right.block < 5);
        CHECK(right.relative_error < 0.012); // so that an error of 6 % of the whole would be found

        // The comparison can fail: albedos that are 10 % off, and a light that shines on both sides.
        std::vector<lesson::Quad> dark = lesson::cornell_box(), both = lesson::cornell_box();
        for (lesson::Quad& quad : dark) quad.material.albedo *= 0.9f;
        const lesson::Quad light = both[0];
        both.push_back({light.corner + Vec3{0, 1e-3f, 0}, light.v, light.u, light.material, light.emission});
        CHECK(compare(dark, 4'000).whole > 5);
        CHECK(compare(both, 1'000).block > 5);
    }

    TEST_CASE("raytrace-10: rays meet a quad where they meet the library's") {
        lesson::Random random(10);
        const auto vector = [&] { return lesson::random_unit_vector(random) * (0.1f + 2 * random.next()); };
        int hits = 0, misses = 0;
        while (hits + misses < 100'000) {
            const lesson::Quad quad{vector(), vector(), vector(), lesson::matte(Rgb(1))};
            if (length(cross(quad.u, quad.v)) < 0.05f) continue;
            const float a = 2 * random.next() - 0.5f, b = 2 * random.next() - 0.5f;
            const auto near_edge = [](float x) { return std::abs(x) < 1e-3f || std::abs(x - 1) < 1e-3f; };
            const Vec3 origin = vector() * 2.0f, target = quad.corner + quad.u * a + quad.v * b;
            const Ray ray{origin, target - origin}; // meets the plane at t = 1
            if (near_edge(a) || near_edge(b) || std::abs(dot(quad.n, ray.direction)) < 0.05f) continue;
            const bool inside = a > 0 && a < 1 && b > 0 && b < 1;
            const auto naive = lesson::hit_quad(quad, ray);
            const auto library = intersect_quad(ShearedRay(ray), duet::Quad{quad.corner, quad.u, quad.v});
            REQUIRE(naive.has_value() == inside);
            REQUIRE(library.has_value() == inside);
            if (inside) REQUIRE(*naive == doctest::Approx(library->t).epsilon(1e-4));
            ++(inside ? hits : misses);
        }
        CHECK(hits > 10'000);
        CHECK(misses > 10'000);
    }
}

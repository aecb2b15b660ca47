// Lesson raytrace-11: its densities are those of what it draws and those of the library; all its strategies have the
// same mean, and the Cornell box has the published one.
#include "common/light/area_sampling.h"
#include "common/sampling/warp.h"
#include "raytrace/integrator/mis.h"
#include "raytrace/lessons/11-monte-carlo/light_sampling.h"
#include "tests/lessons/cornell_comparison.h"

#include <doctest/doctest.h>

using namespace duet;

namespace {

constexpr lesson::Strategy kChance{lesson::all, lesson::none}, kLight{lesson::none, lesson::all},
    kBoth{lesson::power_heuristic, lesson::power_heuristic}, kTwice{lesson::all, lesson::all};

/// A matte floor and a metal plate under two lights of different size.
lesson::Scene two_lights() {
    const lesson::Material black = lesson::matte(Rgb(0));
    return {{{{-1, 2, -1}, {0.5f, 0, 0}, {0, 0, 0.5f}, black, Rgb(4)},
             {{0, 2, -1}, {1, 0, 0}, {0, 0, 1}, black, Rgb(1)},
             {{-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, lesson::matte(Rgb(0.5f))},
             {{-1, 0.3f, 0.5f}, {2, 0, 0}, {0, 0.2f, -0.7f}, lesson::metal(Rgb(0.8f), 0.3f)}},
            2,
            lesson::Camera({.eye = {0, 1.2f, 4}, .look_at = {0, 0.4f, 0}, .fov_degrees = 40}, 1, 1),
            3};
}

struct Estimate {
    double mean, error;
};
Estimate estimate(lesson::Scene scene, const lesson::Strategy& strategy, int paths) {
    lesson::Random random(7);
    double sum = 0, squares = 0;
    for (int i = 0; i < paths; ++i) {
        const float x = random.next(), y = 0.3f + 0.7f * random.next(); // not the lights themselves
        const double light = average(Rgbd(lesson::path_color(scene, x, y, strategy, random)));
        sum += light, squares += light * light;
    }
    const double mean = sum / paths;
    return {mean, std::sqrt((squares / paths - mean * mean) / (paths - 1))};
}

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raytrace-11: directions of a lobe have its density") {
        // The cosine to the power of e + 1 is uniform. Of 160 000 draws in sixteen bins the standard deviation of a bin
        // is 97; the limit is five of them: a false alarm in one of 30 000 seeds.
        constexpr int kDraws = 160'000;
        lesson::Random random(11);
        for (const float e : {1.0f, 5.0f, 100.0f}) {
            const Vec3 axis = lesson::random_unit_vector(random);
            std::array<int, 16> bins{};
            for (int i = 0; i < kDraws; ++i) {
                const Vec3 w = lesson::draw_lobe(axis, e, random);
                REQUIRE(length(w) == doctest::Approx(1).epsilon(1e-4));
                ++bins[static_cast<std::size_t>(min(16 * std::pow(max(dot(w, axis), 0.0f), e + 1), 15.0f))];
            }
            for (const int bin : bins) CHECK(std::abs(bin - kDraws / 16) < 485);
            double integral = 0; // over rings of equal cosine
            for (int i = 0; i < 20'000; ++i) {
                const float z = (static_cast<float>(i) + 0.5f) / 20'000;
                const Vec3 w{std::sqrt(1 - z * z), 0, z};
                integral += static_cast<double>(lesson::lobe_density({0, 0, 1}, e, w)) * 2 * kPiDouble / 20'000;
            }
            CHECK(integral == doctest::Approx(1).epsilon(1e-4));
        }
    }

    TEST_CASE("raytrace-11: densities and weights are the library's") {
        lesson::Random random(12);
        for (int i = 0; i < 20'000; ++i) {
            const Vec3 n = lesson::random_unit_vector(random), w = lesson::random_unit_vector(random);
            REQUIRE(lesson::lobe_density(n, 1, w) == doctest::Approx(cosine_hemisphere_pdf(dot(n, w))).epsilon(1e-5));
            const float own = std::pow(10.0f, 6 * random.next() - 3), other = std::pow(10.0f, 6 * random.next() - 3);
            REQUIRE(lesson::power_heuristic(own, other) == raytrace::mis_weight(own, other));
            const lesson::Quad quad{n, w, lesson::random_unit_vector(random), lesson::matte(Rgb(0))};
            const Vec3 p = lesson::random_unit_vector(random) * 3.0f, q = quad.corner + quad.u * 0.3f + quad.v * 0.6f;
            if (length(cross(quad.u, quad.v)) < 0.1f || std::abs(dot(quad.n, normalize(p - q))) < 0.02f) continue;
            const Vec3d to_q = Vec3d(q) - Vec3d(p);
            const AreaSampling<double> seen{cross(Vec3d(quad.u), Vec3d(quad.v)), to_q};
            const double expected = dot(seen.area_vector, to_q) < 0 ? seen.pdf(to_q) : 0;
            REQUIRE(static_cast<double>(lesson::quad_density(quad, p, q)) == doctest::Approx(expected).epsilon(1e-3));
        }
    }

    TEST_CASE("raytrace-11: all strategies have the same mean") {
        // Two means are apart by five standard errors in less than one of a million seeds.
        const Estimate both = estimate(two_lights(), kBoth, 200'000);
        CHECK(both.error < 0.01 * both.mean);
        const auto apart = [&](const Estimate& e) {
            return std::abs(e.mean - both.mean) / std::sqrt(e.error * e.error + both.error * both.error);
        };
        const Estimate chance = estimate(two_lights(), kChance, 400'000),
                       light = estimate(two_lights(), kLight, 200'000);
        CHECK(apart(chance) < 5);
        CHECK(apart(light) < 5);
        const auto half = [](float, float) { return 0.5f; };
        CHECK(apart(estimate(two_lights(), {half, half}, 200'000)) < 5);
        CHECK(apart(estimate(two_lights(), kTwice, 100'000)) > 5); // the comparison can fail
        CHECK(both.error < light.error);
    }

    TEST_CASE("raytrace-11: the Cornell box with light sampling against an independent renderer") {
        // The odds of a false alarm are those of lesson 10's test.
        lesson::Scene box{lesson::cornell_box(), 1, published_camera(), 64};
        const auto compare = [&](const lesson::Strategy& strategy) {
            return compare_with_published(1'500, [&](float x, float y, lesson::Random& random) {
                return lesson::path_color(box, x, y, strategy, random);
            });
        };
        for (const lesson::Strategy& strategy : {kLight, kBoth}) {
            const CornellComparison found = compare(strategy);
            MESSAGE("whole ", found.whole, ", worst block ", found.block, ", standard error ", found.relative_error);
            CHECK(found.whole < 5);
            CHECK(found.block < 5);
            CHECK(found.relative_error < 0.01);
        }
        CHECK(compare(kTwice).whole > 5); // the comparison can fail
    }
}

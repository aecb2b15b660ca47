// These tests check piecewise constant distributions and the warps of warp.h.
#include "common/sampling/distribution.h"
#include "common/sampling/hash.h"
#include "common/sampling/warp.h"
#include "compare/stress/chi_squared.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;

TEST_SUITE("unit") {
    TEST_CASE("samples fall where the density says, at both ends of u, and never on a zero") {
        const std::vector<double> values{0, 2, 0, 0, 6, 1, 0};
        const Distribution1D d(values);
        CHECK(d.integral() == doctest::Approx(9.0 / 7).epsilon(1e-14));
        CHECK(d.sample(0).index == 1);
        CHECK(d.sample(0).remapped == 0);
        CHECK(d.sample(kOneMinusEpsilon).index == 5);
        CHECK(d.sample(1).index == 5); // out of range: clamped to the largest valid number
        for (int i = 0; i < 10'000; ++i) {
            const auto s = d.sample(static_cast<float>(i) / 10'000);
            REQUIRE(values[s.index] > 0);
            REQUIRE((s.x >= 0 && s.x < 1 && s.remapped >= 0 && s.remapped < 1));
            REQUIRE(s.pdf == d.pdf(s.x));
            REQUIRE(s.pdf == doctest::Approx(values[s.index] * 7 / 9));
            REQUIRE(static_cast<std::size_t>(static_cast<double>(s.x) * 7) == s.index);
        }
        double integral = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            integral += static_cast<double>(d.probability(i));
            CHECK(d.pdf((static_cast<float>(i) + 0.5f) / 7) == doctest::Approx(values[i] * 7 / 9));
        }
        CHECK(integral == doctest::Approx(1).epsilon(1e-6));
        CHECK(d.pdf(-0.1f) == 0);
        CHECK(d.pdf(1) == 0);
        CHECK(d.pdf(std::nanf("")) == 0);
    }

    TEST_CASE("all zero: uniform, and integral() says so; a single value; none") {
        const Distribution1D zero(std::vector<double>(4, 0.0));
        CHECK(zero.integral() == 0);
        CHECK(zero.sample(0.6f).x == doctest::Approx(0.6f));
        CHECK(zero.pdf(0.6f) == 1);
        const Distribution1D one({3.5});
        CHECK(one.integral() == 3.5);
        CHECK(one.sample(0).x == 0);
        CHECK(one.sample(kOneMinusEpsilon).x < 1);
        CHECK(one.sample(0.25f).remapped == 0.25f);
        CHECK(one.probability(0) == 1);
        const Distribution1D none;
        CHECK(none.size() == 0);
        CHECK(none.integral() == 0);
    }

    TEST_CASE("a million intervals of wildly different sizes keep x, index and density together") {
        std::vector<double> values(1'000'000);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = i % 3 == 0 ? 0 : std::ldexp(1.0, static_cast<int>(mix_bits(i) % 60));
        const Distribution1D d(values);
        for (std::uint64_t i = 0; i < 100'000; ++i) {
            const auto s = d.sample(unit_float(high_bits(mix_bits(i))));
            REQUIRE(values[s.index] > 0);
            REQUIRE(s.pdf == d.pdf(s.x));
            REQUIRE(s.pdf > 0);
        }
    }

    TEST_CASE("two dimensions: rows of zeros are left out, density and integral agree") {
        const std::vector<double> values{0, 0, 0, 1, 0, 3, 0, 0, 0, 2, 2, 2}; // 3 × 4 values, rows from v = 0 upward
        const Distribution2D d(values, 3, 4);
        CHECK(d.integral() == doctest::Approx(10.0 / 12));
        const Vec2 corners[] = {
            {0, 0}, {kOneMinusEpsilon, 0}, {0, kOneMinusEpsilon}, {kOneMinusEpsilon, kOneMinusEpsilon}};
        for (const Vec2 u : corners) CHECK(d.sample(u).pdf > 0);
        for (int i = 0; i < 64; ++i)
            for (int j = 0; j < 64; ++j) {
                const auto s = d.sample({(static_cast<float>(i) + 0.5f) / 64, (static_cast<float>(j) + 0.5f) / 64});
                const auto cell = static_cast<std::size_t>(s.uv.y * 4) * 3 + static_cast<std::size_t>(s.uv.x * 3);
                REQUIRE(values[cell] > 0);
                REQUIRE(s.pdf == doctest::Approx(values[cell] * 12 / 10));
                REQUIRE(s.pdf == doctest::Approx(d.pdf(s.uv)));
            }
        const Distribution2D black(std::vector<double>(6, 0.0), 2, 3);
        CHECK(black.integral() == 0);
        CHECK(black.sample({0.5f, 0.5f}).pdf == 1);
        CHECK(Distribution2D().pdf({0.5f, 0.5f}) == 0);
    }

    TEST_CASE("warps stay in their domains at the corners of the square") {
        const float ends[] = {0, 0x1p-24f, 0.25f, 0.5f, 0.75f, kOneMinusEpsilon};
        for (const float x : ends)
            for (const float y : ends) {
                const Vec2 u{x, y};
                const Vec2 disk = concentric_disk(u);
                CHECK(dot(disk, disk) <= 1 + 4e-7f);
                const Vec3 h = cosine_hemisphere(u), s = uniform_sphere(u), c = uniform_cone(u, 1e-9f);
                CHECK(h.z > 0);
                CHECK(length(h) == doctest::Approx(1).epsilon(1e-6));
                CHECK(length(s) == doctest::Approx(1).epsilon(1e-6));
                CHECK(length(c) == doctest::Approx(1).epsilon(1e-6));
                CHECK(std::hypot(c.x, c.y) <= std::sqrt(2e-9f) * 1.000001f);
                const Vec2 b = uniform_triangle(u);
                CHECK((b.x >= 0 && b.y >= 0 && b.x + b.y <= 1));
            }
        CHECK(concentric_disk(Vec2(0.5f, 0.5f)) == Vec2());
    }
}

TEST_SUITE("statistical") {
    // Each case has significance 1e-4 and fixed seeds.
    TEST_CASE("warps have the densities they claim") {
        const double alpha = compare::sidak_level(1e-4, 3);
        const auto sphere = compare::test_directions(
            {}, [](Vec2 u) { return uniform_sphere(u); }, [](Vec3) { return static_cast<double>(kUniformSpherePdf); });
        CHECK_MESSAGE(sphere.chi_squared.p_value > alpha, sphere.chi_squared.details);
        CHECK(sphere.integral == doctest::Approx(1).epsilon(1e-6));
        const auto cosine = compare::test_directions(
            {}, [](Vec2 u) { return cosine_hemisphere(u); },
            [](Vec3 w) { return static_cast<double>(cosine_hemisphere_pdf(w.z)); });
        CHECK_MESSAGE(cosine.chi_squared.p_value > alpha, cosine.chi_squared.details);
        CHECK(cosine.integral == doctest::Approx(1).epsilon(1e-6));

        // The triangle is split into 4 × 4 cells of its barycentric coordinates. Whole cells each hold 1/8 of the
        // area, those on the hypotenuse half as much.
        std::vector<double> count(16), expected(16);
        constexpr int kSamples = 100'000;
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t i = 0; i + j < 4; ++i) expected[j * 4 + i] = kSamples * (i + j == 3 ? 1.0 : 2.0) / 16;
        for (std::uint64_t i = 0; i < kSamples; ++i) {
            const std::uint64_t bits = mix_bits(i + 5);
            const Vec2 b = uniform_triangle(Vec2{unit_float(high_bits(bits)), unit_float(low_bits(bits))});
            ++count[static_cast<std::size_t>(b.y * 4) * 4 + static_cast<std::size_t>(b.x * 4)];
        }
        const auto triangle = compare::chi_squared(count, expected);
        CHECK_MESSAGE(triangle.p_value > alpha, triangle.details);
    }

    TEST_CASE("the chi-squared test finds a density that is wrong by up to 10 %, and knows its quantiles") {
        // The values are the tabulated 5 % points (Abramowitz and Stegun 1964, table 26.8).
        CHECK(compare::chi_squared_tail(3.84146, 1) == doctest::Approx(0.05).epsilon(1e-4));
        CHECK(compare::chi_squared_tail(18.3070, 10) == doctest::Approx(0.05).epsilon(1e-4));
        CHECK(compare::chi_squared_tail(124.342, 100) == doctest::Approx(0.05).epsilon(1e-4));
        const auto wrong = compare::test_directions(
            {}, [](Vec2 u) { return uniform_sphere(u); },
            [](Vec3 w) { return static_cast<double>(kUniformSpherePdf) * (1 + 0.1 * static_cast<double>(w.x)); });
        CHECK(wrong.chi_squared.p_value < 1e-6);
    }
}

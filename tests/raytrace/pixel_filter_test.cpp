// These tests check pixel filters as sampling densities.
#include "common/system/error.h"
#include "raytrace/sampling/pixel_filter.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace duet;

namespace {

/// Holds the moments of the positions of n × n uniformly spaced samples.
struct Moments {
    double mean = 0, variance = 0, farthest = 0;
};
Moments moments(const PixelFilter& filter, int n) {
    Moments m;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec2d p = filter.sample({(static_cast<float>(i) + 0.5f) / static_cast<float>(n),
                                           (static_cast<float>(j) + 0.5f) / static_cast<float>(n)});
            m.mean += (p.x + p.y) / 2 / (n * n);
            m.variance += (p.x * p.x + p.y * p.y) / 2 / (n * n);
            m.farthest = std::max({m.farthest, std::abs(p.x), std::abs(p.y)});
        }
    return m;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("the middle of the square is the pixel's center, its borders the filter's") {
        for (const FilterKind kind : {FilterKind::kBox, FilterKind::kBlackmanHarris}) {
            const PixelFilter filter(kind);
            CHECK(filter.sample({0.5f, 0.5f}) == Vec2d(0, 0));
            const double radius = kind == FilterKind::kBox ? 0.5 : 1.5;
            CHECK(filter.sample({0, 0.5f}).x == doctest::Approx(-radius));
            CHECK(filter.sample({0.5f, kOneMinusEpsilon}).y < radius);
            CHECK(moments(filter, 64).farthest < radius);
        }
    }

    TEST_CASE("moments are the filters': a box's 1/12, and the window's by its Fourier series") {
        CHECK(moments(PixelFilter(FilterKind::kBox), 512).variance == doctest::Approx(1.0 / 12).epsilon(1e-4));
        const Moments m = moments(PixelFilter(FilterKind::kBlackmanHarris), 512);
        CHECK(std::abs(m.mean) < 1e-9);
        // The expected moments come from quadrature, without the code under test.
        double mass = 0, square = 0;
        constexpr int kSteps = 20'000;
        for (int i = 0; i < kSteps; ++i) {
            const double t = (i + 0.5) / kSteps, x = 3 * t - 1.5;
            const double w = 0.35875 - 0.48829 * std::cos(2 * kPiDouble * t) + 0.14128 * std::cos(4 * kPiDouble * t) -
                             0.01168 * std::cos(6 * kPiDouble * t);
            mass += w;
            square += w * x * x;
        }
        CHECK(m.variance == doctest::Approx(square / mass).epsilon(2e-3));
    }

    TEST_CASE("the part of samples below any place is the window's integral") {
        const PixelFilter filter(FilterKind::kBlackmanHarris);
        const auto window = [](double t) {
            return 0.35875 - 0.48829 * std::cos(2 * kPiDouble * t) + 0.14128 * std::cos(4 * kPiDouble * t) -
                   0.01168 * std::cos(6 * kPiDouble * t);
        };
        for (const float u : {0.001f, 0.1f, 0.3f, 0.6f, 0.97f, 0.9999f}) {
            const double end = (filter.sample({u, 0.5f}).x + 1.5) / 3;
            double below = 0;
            constexpr int kSteps = 4000;
            for (int i = 0; i < kSteps; ++i) below += window((i + 0.5) / kSteps * end) * end / kSteps;
            CHECK(below / 0.35875 == doctest::Approx(u).epsilon(2e-3));
        }
    }

    TEST_CASE("names") {
        CHECK(filter_kind("box") == FilterKind::kBox);
        CHECK(filter_kind("blackman-harris") == FilterKind::kBlackmanHarris);
        CHECK_THROWS_AS(filter_kind("gauss"), Error);
    }
}

#include "compare/metrics/error_metrics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace duet;
using compare::error_metrics;
using compare::ErrorMetrics;

namespace {

/// Computes the MSE independently as E[(a − b)²] = E[a²] − 2 E[ab] + E[b²], in long double.
long double mse_from_moments(const ImageRgb& a, const ImageRgb& b) {
    long double aa = 0, ab = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const long double x = a[i][c], y = b[i][c];
            aa += x * x;
            ab += x * y;
            bb += y * y;
        }
    return (aa - 2 * ab + bb) / static_cast<long double>(3 * a.size());
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("metrics of two pixels, computed by hand") {
        ImageRgb a(2, 1), b(2, 1);
        a(0, 0) = {1.0f, 0.5f, 0.0f};
        b(0, 0) = {0.5f, 0.5f, 0.25f};
        a(1, 0) = {0.0f, 2.0f, 1.0f};
        b(1, 0) = {0.0f, 1.0f, 1.0f};
        // The differences are 0.5, 0, −0.25 and 0, 1, 0.
        const ErrorMetrics m = error_metrics(a, b);
        CHECK(m.mse == doctest::Approx((0.25 + 0.0625 + 1.0) / 6));
        CHECK(m.rmse == doctest::Approx(std::sqrt(1.3125 / 6)));
        CHECK(m.mae == doctest::Approx(1.75 / 6));
        CHECK(m.psnr == doctest::Approx(10 * std::log10(6 / 1.3125)));
        CHECK(m.relmse == doctest::Approx((0.25 / 0.26 + 0.0625 / 0.0725 + 1.0 / 1.01) / 6));
        CHECK(m.relmse_trimmed == m.relmse); // 0.1 % of two pixels rounds to zero pixels
        CHECK(m.smape == doctest::Approx((0.5 / 1.51 + 0.25 / 0.26 + 1.0 / 3.01) / 6));
        CHECK(m.mean_signed_error.r == doctest::Approx(0.25));
        CHECK(m.mean_signed_error.g == doctest::Approx(0.5));
        CHECK(m.mean_signed_error.b == doctest::Approx(-0.125));
        CHECK(m.worst == 1.0);
        CHECK(m.worst_x == 1);
        CHECK(m.worst_y == 0);
        CHECK(m.pixels == 2);
    }

    TEST_CASE("equal images: no error, infinite PSNR") {
        const ImageRgb a(5, 4, Rgb(0.3f));
        const ErrorMetrics m = error_metrics(a, a);
        CHECK(m.mse == 0);
        CHECK(m.relmse == 0);
        CHECK(m.psnr == std::numeric_limits<double>::infinity());
        CHECK(m.worst == 0);
    }

    TEST_CASE("the mean squared error agrees with its expansion into moments, and the sums don't stall") {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
        ImageRgb a(512, 512), b(512, 512);
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                a[i][c] = uniform(random);
                b[i][c] = a[i][c] + 1e-3f * uniform(random);
            }
        const double expected = static_cast<double>(mse_from_moments(a, b));
        CHECK(error_metrics(a, b).mse == doctest::Approx(expected).epsilon(1e-9));
        CHECK(error_metrics(b, a).mse == error_metrics(a, b).mse);
        CHECK(error_metrics(b, a).mean_signed_error.g == -error_metrics(a, b).mean_signed_error.g);
    }

    TEST_CASE("the trimmed relative error leaves out the worst 0.1 % of the pixels") {
        ImageRgb a(100, 21, Rgb(1.5f)), b(100, 21, Rgb(1));
        for (const int x : {3, 50, 99}) a(x, 7) = Rgb(100);
        const double each = 0.25 / 1.01, outlier = 99.0 * 99.0 / 1.01;
        CHECK(error_metrics(a, b).relmse == doctest::Approx((2097 * each + 3 * outlier) / 2100));
        CHECK(error_metrics(a, b).relmse_trimmed == doctest::Approx((2097 * each + outlier) / 2098));
    }

    TEST_CASE("pixels that are not finite are counted and left out") {
        ImageRgb a(3, 1, Rgb(1.0f)), b(3, 1, Rgb(0.5f));
        a(0, 0).g = std::numeric_limits<float>::quiet_NaN();
        b(1, 0).b = std::numeric_limits<float>::infinity();
        const ErrorMetrics m = error_metrics(a, b);
        CHECK(m.non_finite_a == 1);
        CHECK(m.non_finite_b == 1);
        CHECK(m.nan_a == 1);
        CHECK(m.infinite_a == 0);
        CHECK(m.nan_b == 0);
        CHECK(m.infinite_b == 1);
        CHECK(m.pixels == 1);
        CHECK(m.mse == doctest::Approx(0.25));
        CHECK(m.worst_x == 2);
    }

    TEST_CASE("no finite pixel: the means are no numbers, not zero") {
        const ImageRgb a(2, 2, Rgb(std::numeric_limits<float>::quiet_NaN())), b(2, 2);
        const ErrorMetrics m = error_metrics(a, b);
        CHECK(std::isnan(m.mse));
        CHECK(std::isnan(m.relmse));
        CHECK(std::isnan(m.worst));
    }

    TEST_CASE("images of different sizes are refused") {
        CHECK_THROWS_AS(error_metrics(ImageRgb(2, 3), ImageRgb(3, 2)), Error);
    }
}

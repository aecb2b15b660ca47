#include "compare/metrics/image_metrics.h"

#include "compare/metrics/ssim.h"
#include "tests/compare/golden_figures.h"
#include "tests/compare/test_images.h"

#include <doctest/doctest.h>

#include <limits>
#include <set>

using namespace duet;
using namespace duet::compare;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void check_figure(double value, double expected, double rounding = 0) {
    CHECK(std::abs(value - expected) < 1e-4 * std::abs(expected) + rounding);
}

/// Compares each metric with another program's value, to a relative tolerance of 1e-4. The smallest FLIP value is
/// that of one pixel, a small difference of float colors up to 100. Their rounding error is 1.5e-7 of the largest
/// distance, and several errors add up.
void check_golden(const std::string& pair, const ImageMetrics& metrics) {
    for (const MetricValue& figure : metric_values(metrics)) {
        if (figure.name.rfind("z_", 0) == 0 || figure.name == "nan" || figure.name == "infinite" ||
            figure.name == "mean_signed_error")
            continue;
        CAPTURE(figure.name);
        check_figure(figure.value, golden_figure(pair, figure.name), figure.name == "flip_min" ? 1e-6 : 0);
    }
    const Rgbd signed_error = metrics.errors.mean_signed_error;
    check_figure(signed_error.r, golden_figure(pair, "mean_signed_error_r"));
    check_figure(signed_error.g, golden_figure(pair, "mean_signed_error_g"));
    check_figure(signed_error.b, golden_figure(pair, "mean_signed_error_b"));
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("all metrics equal other programs' on a pair of encoded and one of linear images") {
        const TestPair encoded = encoded_pair(), linear = linear_pair();
        const ImageMetrics metrics = image_metrics(linear.test, linear.reference, Encoding::kLinear);
        check_golden("encoded", image_metrics(encoded.test, encoded.reference, Encoding::kEncoded));
        check_golden("linear", metrics);
        CHECK(metrics.errors.worst_x == golden_figure("linear", "worst_x"));
        CHECK(metrics.errors.worst_y == golden_figure("linear", "worst_y"));
    }

    TEST_CASE("encoded values are compared as stored but by the three figures of linear light") {
        const TestPair pair = encoded_pair(40, 40);
        const ImageMetrics stored = image_metrics(pair.test, pair.reference, Encoding::kEncoded);
        const ImageMetrics as_is = image_metrics(pair.test, pair.reference, Encoding::kLinear);
        const ImageMetrics linear = image_metrics(decoded(pair.test), decoded(pair.reference), Encoding::kLinear);
        CHECK(stored.errors.mse == as_is.errors.mse);
        CHECK(stored.errors.worst == as_is.errors.worst);
        CHECK(stored.ssim == as_is.ssim);
        CHECK(stored.errors.relmse == linear.errors.relmse);
        CHECK(stored.errors.relmse_trimmed == linear.errors.relmse_trimmed);
        CHECK(stored.errors.smape == linear.errors.smape);
        CHECK(stored.errors.mean_signed_error == linear.errors.mean_signed_error);
        CHECK(stored.errors.relmse != as_is.errors.relmse);
        CHECK(stored.flip.exposures == 0);
        CHECK(linear.flip.exposures > 0);
    }

    TEST_CASE("figures have names of their own, the same with and without a z-test") {
        std::set<std::string> names;
        for (const MetricValue& figure : metric_values({})) names.insert(figure.name);
        CHECK(names.size() == metric_values({}).size());
        ImageMetrics tested;
        tested.z = ZTest{};
        CHECK(metric_values(tested).size() == names.size());
        for (const char* const name : {"mse", "psnr", "relmse", "smape", "ssim", "flip", "mean_signed_error", "z_p"})
            CHECK(names.count(name) == 1);
    }

    TEST_CASE("SSIM: 1 for equal images, -1 at most for opposite structure, none below 11 pixels") {
        const TestPair pair = linear_pair(30, 25);
        CHECK(ssim(pair.test, pair.test) == doctest::Approx(1));
        ImageRgb up(11, 11), down(11, 11);
        for (int i = 0; i < 121; ++i) {
            up[static_cast<std::size_t>(i)] = Rgb(i % 2 == 0 ? 1.0f : -1.0f);
            down[static_cast<std::size_t>(i)] = Rgb(i % 2 == 0 ? -1.0f : 1.0f);
        }
        CHECK(ssim(up, down) < -0.99);
        CHECK(std::isnan(ssim(ImageRgb(10, 40), ImageRgb(10, 40))));
        CHECK(std::isnan(ssim(ImageRgb(40, 10), ImageRgb(40, 10))));
        CHECK_THROWS_AS(ssim(ImageRgb(20, 30), ImageRgb(30, 20)), Error);
        // Constant images have no variance at any brightness, so only the term of the means remains.
        for (const float bright : {1.0f, 3e4f, 3e8f}) {
            const double a = static_cast<double>(bright), b = static_cast<double>(bright * 1.25f), c1 = 1e-4;
            const double expected = (2 * a * b + c1) / (a * a + b * b + c1);
            CHECK(ssim(ImageRgb(20, 20, Rgb(bright)), ImageRgb(20, 20, Rgb(bright * 1.25f))) ==
                  doctest::Approx(expected).epsilon(1e-9));
        }
    }

    TEST_CASE("SSIM leaves out windows that are not finite, and has the same bits for any number of threads") {
        TestPair pair = linear_pair(60, 40);
        const double one = ssim(pair.test, pair.reference, 1);
        CHECK(ssim(pair.test, pair.reference, 2) == one);
        CHECK(ssim(pair.test, pair.reference, 7) == one);
        // If the left half is masked out, the value is that of the right half alone.
        ImageRgb right_a(30, 40), right_b(30, 40);
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 30; ++x) {
                right_a(x, y) = pair.test(x + 30, y);
                right_b(x, y) = pair.reference(x + 30, y);
                pair.test(x, y) = Rgb(kNan);
            }
        CHECK(ssim(pair.test, pair.reference) == doctest::Approx(ssim(right_a, right_b)).epsilon(1e-12));
    }
}

#include "compare/metrics/flip.h"

#include "common/image/image_file.h"
#include "tests/compare/golden_figures.h"
#include "tests/compare/test_images.h"

#include <doctest/doctest.h>

#include <limits>

using namespace duet;
using namespace duet::compare;

namespace {

namespace fs = std::filesystem;

/// This folder beside the checkout contains an external image pair. The tests that use it are skipped if it is missing.
const fs::path kPair = fs::path(DUET_SOURCE_DIR) / ".." / "shared" / "flip";
const bool kNoPair = !fs::exists(kPair / "a_ref.exr");

/// Returns the values as stored in the file.
ImageRgb stored(const fs::path& path) {
    const StoredImage file = read_stored_image(path);
    REQUIRE(file.channels == 3);
    ImageRgb image(file.width, file.height);
    for (std::size_t i = 0; i < image.size(); ++i)
        image[i] = {file.values[3 * i], file.values[3 * i + 1], file.values[3 * i + 2]};
    return image;
}

void check_pooled(const Flip& flip, const Flip& expected, double tolerance) {
    CHECK(std::abs(flip.mean - expected.mean) < tolerance);
    CHECK(std::abs(flip.weighted_median - expected.weighted_median) < tolerance);
    CHECK(std::abs(flip.first_quartile - expected.first_quartile) < tolerance);
    CHECK(std::abs(flip.third_quartile - expected.third_quartile) < tolerance);
    CHECK(std::abs(flip.min - expected.min) < tolerance);
    CHECK(std::abs(flip.max - expected.max) < tolerance);
}

Flip golden_flip(const std::string& pair) {
    const auto figure = [&](const char* name) { return golden_figure(pair, name); };
    return {{},
            figure("flip"),
            figure("flip_weighted_median"),
            figure("flip_first_quartile"),
            figure("flip_third_quartile"),
            figure("flip_min"),
            figure("flip_max")};
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("FLIP meets the figures of NVIDIA's tool on a rendered pair" * doctest::skip(kNoPair)) {
        const Flip found = flip(stored(kPair / "a_test.png"), stored(kPair / "a_ref.png"));
        check_pooled(found, {{}, 0.115403, 0.130151, 0.097042, 0.171391, 0.000914, 0.446722}, 5e-5);
    }

    TEST_CASE("HDR-FLIP meets the figures of NVIDIA's tool on a rendered pair" * doctest::skip(kNoPair)) {
        const HdrFlip found = hdr_flip(read_image(kPair / "a_test.exr"), read_image(kPair / "a_ref.exr"));
        check_pooled(found, {{}, 0.126970, 0.152011, 0.101675, 0.217610, 0.014766, 0.726990}, 5e-5);
        CHECK(std::abs(found.start_exposure + 2.5589) < 1e-4);
        CHECK(std::abs(found.stop_exposure - 4.5692) < 1e-4);
        CHECK(found.exposures == 8);
    }

    TEST_CASE("FLIP and HDR-FLIP equal a double-precision implementation by full two-dimensional filters") {
        const TestPair encoded = encoded_pair(), linear = linear_pair();
        check_pooled(flip(encoded.test, encoded.reference), golden_flip("encoded"), 1e-4);
        const HdrFlip found = hdr_flip(linear.test, linear.reference);
        check_pooled(found, golden_flip("linear"), 1e-4);
        CHECK(std::abs(found.start_exposure - golden_figure("linear", "flip_start_exposure")) < 1e-4);
        CHECK(std::abs(found.stop_exposure - golden_figure("linear", "flip_stop_exposure")) < 1e-4);
        CHECK(found.exposures == golden_figure("linear", "flip_exposures"));
    }

    TEST_CASE("FLIP of equal images is 0, of swapped ones the same") {
        const TestPair pair = encoded_pair();
        CHECK(flip(pair.test, pair.test).max == 0);
        CHECK(flip(pair.test, pair.reference).map.pixels() == flip(pair.reference, pair.test).map.pixels());
        CHECK(hdr_flip(pair.test, pair.test).max == 0);
    }

    TEST_CASE("FLIP of black and white is all but 1; of images beyond [0, 1] that of clamped ones") {
        const ImageRgb black(30, 30), white(30, 30, Rgb(1)), bright(30, 30, Rgb(7)), negative(30, 30, Rgb(-1));
        CHECK(flip(black, white).min > 0.96); // green and blue differ most of all color pairs
        CHECK(flip(negative, bright).map.pixels() == flip(black, white).map.pixels());
    }

    TEST_CASE("FLIP has the same bits for any number of threads") {
        const TestPair pair = linear_pair(70, 150);
        const HdrFlip one = hdr_flip(pair.test, pair.reference, kFlipPixelsPerDegree, 1);
        for (const int threads : {2, 7}) {
            const HdrFlip more = hdr_flip(pair.test, pair.reference, kFlipPixelsPerDegree, threads);
            CHECK(more.map.pixels() == one.map.pixels());
            CHECK(more.mean == one.mean);
        }
    }

    TEST_CASE("FLIP of an image does not depend on how its rows are worked on: transposed, the map is transposed") {
        const TestPair pair = encoded_pair(67, 131);
        const auto transposed = [](const auto& image) {
            auto result = std::decay_t<decltype(image)>(image.height(), image.width());
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x) result(y, x) = image(x, y);
            return result;
        };
        const ImageFloat a = flip(pair.test, pair.reference).map;
        const ImageFloat b = transposed(flip(transposed(pair.test), transposed(pair.reference)).map);
        float worst = 0;
        for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
        CHECK(worst < 2e-4f);
    }

    TEST_CASE("images smaller than the filters, down to one pixel") {
        for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 40), std::pair(40, 2)}) {
            const TestPair pair = encoded_pair(width, height);
            const Flip found = flip(pair.test, pair.reference);
            CHECK(found.max <= 1);
            CHECK(found.min >= 0);
            CHECK(found.mean > 0);
        }
    }

    TEST_CASE("a pixel that is not finite is left out, and does not spread") {
        TestPair pair = linear_pair(40, 40);
        pair.test(20, 20).g = std::numeric_limits<float>::quiet_NaN();
        pair.reference(3, 3).b = std::numeric_limits<float>::infinity();
        const HdrFlip found = hdr_flip(pair.test, pair.reference);
        int bad = 0;
        for (const float error : found.map) bad += std::isfinite(error) ? 0 : 1;
        CHECK(bad == 2);
        CHECK(std::isnan(found.map(20, 20)));
        CHECK(std::isnan(found.map(3, 3)));
        CHECK(std::isfinite(found.mean));
        CHECK(std::isfinite(found.stop_exposure));
        const ImageRgb nothing(4, 4, Rgb(std::numeric_limits<float>::quiet_NaN()));
        CHECK(std::isnan(hdr_flip(nothing, nothing).mean));
        CHECK(std::isnan(hdr_flip(nothing, nothing).max));
    }

    TEST_CASE("exposures of references that are black, or mostly, or very bright") {
        const HdrFlip black = hdr_flip(ImageRgb(12, 12, Rgb(1)), ImageRgb(12, 12));
        CHECK(black.exposures == 1);
        CHECK(black.start_exposure == 0);
        ImageRgb spots(12, 12);
        spots(2, 2) = Rgb(8);
        spots(7, 7) = spots(9, 7) = Rgb(2);
        const HdrFlip mostly = hdr_flip(ImageRgb(12, 12), spots); // the median of 2, 2 and 8: two stops
        CHECK(mostly.exposures == 2);
        CHECK(mostly.stop_exposure - mostly.start_exposure == doctest::Approx(2));
        const HdrFlip bright = hdr_flip(ImageRgb(12, 12, Rgb(1e38f)), ImageRgb(12, 12, Rgb(1e38f)));
        CHECK(bright.max == 0);
        const HdrFlip faint = hdr_flip(ImageRgb(12, 12), ImageRgb(12, 12, Rgb(1e-40f)));
        CHECK(std::isfinite(faint.mean));
    }

    TEST_CASE("FLIP of images of different sizes is refused") {
        CHECK_THROWS_AS(flip(ImageRgb(2, 3), ImageRgb(3, 2)), Error);
        CHECK_THROWS_AS(hdr_flip(ImageRgb(2, 3), ImageRgb(2, 2)), Error);
    }
}

// These tests compute the shares of a difference for simple images whose shares are known.
#include "compare/ladder/shares.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace duet;
using namespace duet::compare;

namespace {

/// Returns a ladder with the same image at all steps.
LadderImages level(const ImageRgb& image) {
    LadderImages images;
    images.first = image;
    for (auto& half : images.halves) half.fill(image);
    return images;
}

/// Adds light to steps k and above (k from 1), in one half or both.
void rise(LadderImages& images, std::size_t k, Rgb by, std::size_t pixel, int half = -1) {
    for (int h = 0; h < 2; ++h)
        for (std::size_t step = k; (half < 0 || half == h) && step <= kRungCount; ++step)
            images.halves[static_cast<std::size_t>(h)][step - 1][pixel] += by;
}

LadderImages random_images(int width, int height, unsigned seed) {
    std::mt19937 generator(seed);
    std::exponential_distribution<float> light(0.7f);
    LadderImages images = level(ImageRgb(width, height));
    const auto fill = [&](ImageRgb& image) {
        for (Rgb& pixel : image.pixels()) pixel = {light(generator), light(generator), light(generator) * 1000};
    };
    fill(images.first);
    for (auto& half : images.halves)
        for (ImageRgb& image : half) fill(image);
    return images;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("shares add up to 1 whatever the images, by computation: to 1e-12") {
        for (unsigned seed = 0; seed < 20; ++seed) {
            const Shares s = shares(random_images(61, 43, seed));
            CHECK(std::abs(s.sum - 1) < 1e-12);
            CHECK(s.share[kNoise] > 0.01);
            CHECK_FALSE(s.negligible);
        }
    }

    TEST_CASE("one step that changes: all of the difference is its share, and all pixels are its own") {
        for (std::size_t k = 1; k <= kRungCount; ++k) {
            LadderImages images = level(ImageRgb(8, 4, Rgb(0.25f)));
            for (std::size_t i = 0; i < 16; ++i) rise(images, k, Rgb(0.5f, 0, 0.125f), i);
            const Shares s = shares(images);
            CHECK(s.share[k - 1] == doctest::Approx(1).epsilon(1e-14));
            CHECK(s.rms == doctest::Approx(std::sqrt((0.25 + 0.015625) / 3 / 2)).epsilon(1e-12));
            const CauseMap map = map_causes(images);
            CHECK(map.visible == 0.5);
            CHECK(map.pixels[k - 1] == 1);
            CHECK(map.cause[0] == k - 1);
            CHECK(map.steps[0] == 88); // sRGB: 0.25 is 137, 0.75 is 225
            CHECK(map.steps[31] == 0);
        }
    }

    TEST_CASE("steps that cancel have shares of both signs: +2 and −1 of a change of 1") {
        LadderImages images = level(ImageRgb(1, 1, Rgb(4)));
        rise(images, 3, Rgb(2), 0);
        rise(images, 6, Rgb(-1), 0);
        const Shares s = shares(images);
        CHECK(s.share[2] == doctest::Approx(2));
        CHECK(s.share[5] == doctest::Approx(-1));
        CHECK(s.sum == doctest::Approx(1));
    }

    TEST_CASE("what the halves do not agree on is noise: ±n about a change d have shares d² and n² of d² + … each") {
        // Half A is too bright by n and half B too dark by n, so D = d and ⟨Dᴬ, Dᴮ⟩ = d² − n².
        const double d = 2, n = 0.5;
        LadderImages images = level(ImageRgb(3, 3, Rgb(4)));
        for (std::size_t i = 0; i < 9; ++i) {
            rise(images, 4, Rgb(2), i);
            rise(images, 7, Rgb(0.5f), i, 0);
            rise(images, 7, Rgb(-0.5f), i, 1);
        }
        const Shares s = shares(images);
        CHECK(s.share[kNoise] == doctest::Approx(n * n / (d * d)));
        CHECK(s.share[3] == doctest::Approx(1)); // ½ (d(d − n) + d(d + n)) / d²
        CHECK(s.share[6] == doctest::Approx(-n * n / (d * d)));
        CHECK(std::abs(s.sum - 1) < 1e-14);
    }

    TEST_CASE("noise without a difference is the noise's, not the last rung's") {
        std::mt19937 generator(3);
        std::normal_distribution<float> noise(0, 0.1f);
        LadderImages images = level(ImageRgb(64, 64, Rgb(1)));
        for (std::size_t i = 0; i < images.first.size(); ++i)
            for (int half = 0; half < 2; ++half) rise(images, 7, Rgb(noise(generator)), i, half);
        const Shares s = shares(images);
        // ‖(A − B)/2‖² and ‖(A + B)/2‖² are sums of 4096 independent squares of equal variance, so their ratio has a
        // standard error of 3 %.
        CHECK(s.share[kNoise] == doctest::Approx(1).epsilon(0.05));
        CHECK(std::abs(s.share[6]) < 0.15);
    }

    TEST_CASE("equal images, and such as differ by rounding, have nothing to share out") {
        LadderImages images = level(ImageRgb(5, 5, Rgb(0.5f)));
        CHECK(shares(images).negligible);
        rise(images, 3, Rgb(1e-7f), 7);
        CHECK(shares(images).negligible);
        rise(images, 3, Rgb(0.01f), 7);
        CHECK_FALSE(shares(images).negligible);
        CHECK(shares(level(ImageRgb(5, 5))).negligible); // black
        CHECK(map_causes(level(ImageRgb(5, 5))).visible == 0);
    }

    TEST_CASE("a pixel's causes add up to the square of its difference") {
        const LadderImages images = random_images(7, 5, 1);
        const ImageRgb last = images.image(kRungCount);
        for (std::size_t i = 0; i < last.size(); ++i) {
            double sum = 0, square = 0;
            for (const double cause : pixel_causes(images, i)) sum += cause;
            for (std::size_t c = 0; c < 3; ++c)
                square += sqr(static_cast<double>(images.first[i][c]) - static_cast<double>(last[i][c]));
            CHECK(sum == doctest::Approx(square).epsilon(1e-4)); // `last` is rounded to float
        }
    }

    TEST_CASE("the largest cause is that of a pixel and its neighbors; a share, that of each pixel by itself") {
        LadderImages images = level(ImageRgb(5, 5, Rgb(0.1f)));
        for (std::size_t i = 0; i < 25; ++i) rise(images, i == 12 ? 6 : 4, Rgb(0.5f), i);
        CauseMap map = map_causes(images);
        CHECK(map.cause(2, 2) == 3);
        CHECK(map.pixels[3] == 1);
        CHECK(shares(images).share[5] == doctest::Approx(1.0 / 25));
        rise(images, 6, Rgb(1.5f), 12); // 2² outweighs 8 · 0.5², also at the neighboring pixels
        map = map_causes(images);
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 5; ++x) CHECK(map.cause(x, y) == (x % 4 > 0 && y % 4 > 0 ? 5 : 3));
    }

    TEST_CASE("the image of causes: full colors where much is to be seen, dark where nothing is") {
        LadderImages images = level(ImageRgb(2, 1, Rgb(0.1f)));
        rise(images, 4, Rgb(0.5f), 0);
        const ImageRgb image = cause_image(map_causes(images));
        CHECK(image(0, 0).b > image(0, 0).r); // blue: shadows
        CHECK(image(0, 0).b > 0.3f);
        CHECK(max_component(image(1, 0)) < 0.01f);
        for (std::size_t a = 0; a < kCauseCount; ++a)
            for (std::size_t b = 0; b < a; ++b) CHECK(cause_color(a) != cause_color(b));
    }
}

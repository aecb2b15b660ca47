#include "compare/metrics/z_test.h"

#include "compare/metrics/normal_distribution.h"

#include <doctest/doctest.h>

#include <limits>
#include <random>

using namespace duet;
using namespace duet::compare;

namespace {

/// Holds an image of two replicates and the variance estimated from them, as Film does.
struct Noisy {
    ImageRgb values, variance;
    operator NoisyImage() const { return {values, variance}; }
};

/// Calls draw(x, y, c) for one replicate of one value.
template <typename Draw> Noisy noisy(int width, int height, const Draw& draw) {
    Noisy noisy{ImageRgb(width, height), ImageRgb(width, height)};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                const double first = draw(x, y, c), second = draw(x, y, c);
                noisy.values(x, y)[c] = static_cast<float>((first + second) / 2);
                noisy.variance(x, y)[c] = static_cast<float>(sqr(first - second) / 4);
            }
    return noisy;
}

/// Returns a standard deviation that varies by a factor of 1000 over the image, and by another 30 in single columns.
double uneven_sigma(int x, int y) { return 0.01 * std::pow(1000.0, (x + y) / 126.0) * (x % 16 == 5 ? 30 : 1); }

Noisy normal_image(std::mt19937_64& random, double shift = 0) {
    std::normal_distribution<double> normal;
    return noisy(64, 64, [&](int x, int y, std::size_t) { return 1 + shift + uneven_sigma(x, y) * normal(random); });
}

/// Returns light that one of eight replicates finds, like that of a small mirror, with mean 1.
Noisy rare_image(std::mt19937_64& random) {
    std::bernoulli_distribution seen(0.125);
    return noisy(64, 64, [&](int, int, std::size_t) { return seen(random) ? 8.0 : 0.0; });
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("normal tails, quantiles and the correction for many tests") {
        CHECK(two_sided_p(1.959963985) == doctest::Approx(0.05));
        CHECK(two_sided_p(-10) == doctest::Approx(1.523970604832e-23).epsilon(1e-9));
        CHECK(upper_quantile(0.025) == doctest::Approx(1.959963985));
        CHECK(upper_quantile(0.01) == doctest::Approx(2.326347874));
        CHECK(upper_quantile(0.5) == doctest::Approx(0));
        CHECK(sidak(0.01, 3) == doctest::Approx(1 - 0.99 * 0.99 * 0.99));
        CHECK(sidak(1e-20, 1000) == doctest::Approx(1e-17));
        CHECK(sidak(sidak_level(0.01, 500), 500) == doctest::Approx(0.01));
    }

    TEST_CASE("the sums of a z-test, computed by hand") {
        // One value per channel differs by 3, with variance 4 there, so V = (4 + 9) / 2.
        ImageRgb a(1, 1, Rgb(5, 2, 2)), b(1, 1, Rgb(2, 2, 2)), variance(1, 1, Rgb(4));
        const ZTest test = z_test({a, variance}, {b, {}});
        CHECK(test.mean_z.r == doctest::Approx(3 / std::sqrt(6.5)));
        CHECK(test.mean_z.g == 0);
        CHECK(test.tests == 6);
        CHECK(test.pixels == 1);
        CHECK(test.largest == doctest::Approx(1.5)); // a single pixel has only its own variance
        CHECK(test.channel == 0);
        CHECK(test.p == doctest::Approx(sidak(two_sided_p(3 / std::sqrt(6.5)), 6)));
    }

    TEST_CASE("equal exact parts differ by rounding only; what has no variance is not tested") {
        ImageRgb a(32, 32, Rgb(17)), b(32, 32, Rgb(17.00001f)), variance(32, 32);
        CHECK(z_test({a, variance}, {b, {}}).tests == 0);
        CHECK(z_test({a, variance}, {b, {}}).p == 1);
        for (Rgb& pixel : variance.pixels()) pixel = Rgb(1e-12f);
        CHECK(z_test({a, variance}, {b, {}}).p == 1);
        b(9, 9).r = 16;
        CHECK(z_test({a, variance}, {b, {}}).largest > 1e5);
        b(9, 9).r = 17;
        a(3, 3) = Rgb(std::numeric_limits<float>::quiet_NaN());
        variance(4, 4) = Rgb(std::numeric_limits<float>::infinity());
        b(5, 5) = a(5, 5) = variance(5, 5) = Rgb(0);
        CHECK(z_test({a, variance}, {b, {}}).pixels == 32 * 32 - 3);
        const ImageRgb black(8, 8);
        const ZTest nothing = z_test({black, black}, {black, black});
        CHECK(nothing.tests == 0);
        CHECK(nothing.p == 1);
    }

    TEST_CASE("one wrong pixel is the largest z, one wrong block the most unlikely") {
        std::mt19937_64 random(3);
        std::normal_distribution<double> normal;
        const auto draw = [&](int, int, std::size_t) { return 1 + 0.1 * normal(random); };
        const Noisy b = noisy(128, 96, draw);
        Noisy a = noisy(128, 96, draw);
        a.values(70, 20).g += 3;
        const ZTest pixel = z_test(a, b);
        CHECK(pixel.largest > 20);
        CHECK(pixel.largest_x == 70);
        CHECK(pixel.largest_y == 20);
        for (int y = 32; y < 64; ++y)
            for (int x = 96; x < 128; ++x) a.values(x, y).b += 0.03f;
        const ZTest block = z_test(a, b);
        CHECK(block.p < 1e-6);
        CHECK(block.x == 96);
        CHECK(block.y == 32);
        CHECK(block.width == 32);
        CHECK(block.channel == 2);
    }

    TEST_CASE("sizes that differ and images without any variance are refused") {
        const ImageRgb a(4, 4), b(4, 5), none;
        CHECK_THROWS_AS(z_test({a, a}, {b, b}), Error);
        CHECK_THROWS_AS(z_test({a, b}, {a, none}), Error);
        CHECK_THROWS_AS(z_test({a, none}, {a, none}), Error);
    }
}

TEST_SUITE("statistical") {

    // There are 1000 pairs at level 0.01. At most 10 false alarms are expected (15 correlated tests); more than 25
    // have odds below 2e-5 (Poisson).
    TEST_CASE("false alarms are as rare as promised, with uneven noise and variances of two replicates") {
        std::mt19937_64 random(11);
        int both = 0, one = 0;
        const ImageRgb truth(64, 64, Rgb(1)), none;
        for (int i = 0; i < 1000; ++i) {
            const Noisy a = normal_image(random);
            one += z_test(a, {truth, none}).p < 0.01;
            if (i % 2 == 0) both += z_test(a, normal_image(random)).p < 0.01;
        }
        CHECK(one <= 25);
        CHECK(both <= 17); // of 500: odds below 3e-5
    }

    // The light is missed by most replicates, so a pixel's own variance is 0 in three of four pixels.
    TEST_CASE("false alarms are rare with noise far from normal, too") {
        std::mt19937_64 random(12);
        int alarms = 0;
        const ImageRgb truth(64, 64, Rgb(1)), none;
        for (int i = 0; i < 500; ++i) alarms += z_test(rare_image(random), {truth, none}).p < 0.01;
        // Skewness may double the 5 false alarms that are expected; with 10 expected the odds are below 1e-4.
        CHECK(alarms <= 25);
    }

    // A difference of the detectable size is found in 99 of 100 cases. Of 300 pairs, more than 10 misses have odds
    // below 3e-4.
    TEST_CASE("a difference of the size called detectable is found") {
        std::mt19937_64 random(13);
        const ImageRgb truth(64, 64, Rgb(1)), none;
        // The noise of the estimate itself is 2 %.
        const double shift = z_test(normal_image(random), {truth, none}).detectable.g * 1.1;
        int missed = 0;
        for (int i = 0; i < 300; ++i) missed += !(z_test(normal_image(random, shift), {truth, none}).p < 0.01);
        CHECK(missed <= 10);
    }
}

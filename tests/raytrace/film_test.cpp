#include "raytrace/film/film.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace duet;

TEST_SUITE("unit") {

    TEST_CASE("2^25 equal samples add up without stalling") {
        Film film(1, 1);
        for (int i = 0; i < (1 << 25); ++i) film.add(0, 0, static_cast<std::size_t>(i & 1), Rgb(0.1f));
        CHECK(film.mean(0, 0).r == doctest::Approx(static_cast<double>(0.1f)).epsilon(1e-9));
        CHECK(film.samples(0, 0) == 1u << 25);
        CHECK(film.variance(0, 0).r < 1e-12);
    }

    TEST_CASE("bad samples are dropped and counted") {
        Film film(2, 1);
        CHECK(film.add(0, 0, 0, Rgb(2)));
        CHECK_FALSE(film.add(0, 0, 0, Rgb(NAN, 0, 0)));
        CHECK_FALSE(film.add(0, 0, 1, Rgb(0, INFINITY, 0)));
        CHECK_FALSE(film.add(0, 0, 1, Rgb(0, 0, -1)));
        CHECK(film.invalid_samples() == 3);
        CHECK(film.mean(0, 0) == Rgbd(2));
        CHECK(std::isinf(film.variance(0, 0).r)); // one replicate is empty, so the variance is unknown
        CHECK(film.estimated_relmse() == -1);
        CHECK(is_black(film.mean(1, 0)));
    }

    TEST_CASE("a rare bright sample does not hide itself in the estimate of relMSE; what both replicates find counts "
              "in full") {
        const auto estimate = [](float first, float second) { // the center of 3 × 3 pixels; the others are 1 and exact
            Film film(3, 3);
            for (int y = 0; y < 3; ++y)
                for (int x = 0; x < 3; ++x)
                    for (const std::size_t replicate : {0u, 1u})
                        film.add(x, y, replicate, Rgb(x == 1 && y == 1 ? (replicate == 0 ? first : second) : 1.0f));
            return film.estimated_relmse();
        };
        // The squared half difference ((101 − 1) / 2)² is divided by 1 + 0.01, not by the squared mean 51². The pixel
        // counts for a ninth of the image.
        CHECK(estimate(101, 1) == doctest::Approx(50.0 * 50 / 1.01 / 9));
        CHECK(estimate(1, 101) == estimate(101, 1));
        CHECK(estimate(100, 102) == doctest::Approx(1.0 / (100.0 * 100 + 0.01) / 9)); // a light
        // A pixel that is darker than its neighbors is not clamped.
        CHECK(estimate(0, 1) == doctest::Approx(0.25 / (0.25 + 0.01) / 9));
    }

    TEST_CASE("the variance image is finite where the variance is, however large, and infinite where it is unknown") {
        Film film(2, 1);
        film.add(0, 0, 0, Rgb(1e30f));
        film.add(0, 0, 1, Rgb(0.0f));
        film.add(1, 0, 0, Rgb(1.0f));
        const ImageRgb image = film.variance_image();
        CHECK(image(0, 0).r == std::numeric_limits<float>::max());
        CHECK(std::isinf(image(1, 0).r));
    }

} // TEST_SUITE

TEST_SUITE("statistical") {

    // The estimate's mean over 4,000 pixels has a relative standard error of about sqrt(2/4000) = 2.2 %. The
    // tolerance of 11 % is five standard errors, so a false alarm has odds of 1 in 2 million.
    TEST_CASE("the variance estimate is unbiased, for unequal replicates too") {
        std::mt19937 engine(3);
        std::uniform_real_distribution<float> u(0, 1);
        Film film(4000, 1);
        const int n0 = 6, n1 = 3;
        for (int x = 0; x < 4000; ++x) {
            for (int i = 0; i < n0; ++i) film.add(x, 0, 0, Rgb(u(engine)));
            for (int i = 0; i < n1; ++i) film.add(x, 0, 1, Rgb(u(engine)));
        }
        double sum = 0;
        for (int x = 0; x < 4000; ++x) sum += film.variance(x, 0).r;
        const double expected = (1.0 / 12) / (n0 + n1);
        CHECK(sum / 4000 == doctest::Approx(expected).epsilon(0.11));
    }

} // TEST_SUITE

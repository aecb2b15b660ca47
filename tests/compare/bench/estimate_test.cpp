#include "compare/bench/estimate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace duet::compare;
using doctest::Approx;

TEST_SUITE("unit") {

    TEST_CASE("Student's distribution: critical values of the printed tables") {
        // The values are from Abramowitz and Stegun 1964, table 26.10, two-sided.
        CHECK(student_t_critical(0.05, 1) == Approx(12.706).epsilon(1e-4));
        CHECK(student_t_critical(0.05, 4) == Approx(2.776).epsilon(1e-3));
        CHECK(student_t_critical(0.05, 9) == Approx(2.262).epsilon(1e-3));
        CHECK(student_t_critical(0.01, 2) == Approx(9.925).epsilon(1e-4));
        CHECK(student_t_critical(0.001, 30) == Approx(3.646).epsilon(1e-3));
        CHECK(student_t_critical(0.05, 1e7) == Approx(1.959964).epsilon(1e-5));
        // Closed forms exist for one degree of freedom (Cauchy's distribution) and for two (an elementary function).
        for (const double t : {0.1, 1.0, 7.0, 1e4}) {
            CHECK(student_t_tail(t, 1) == Approx(1 - 2 / M_PI * std::atan(t)).epsilon(1e-9));
            CHECK(student_t_tail(-t, 2) == Approx(1 - t / std::sqrt(2 + t * t)).epsilon(1e-7));
        }
        CHECK(student_t_tail(0, 5) == 1);
        CHECK(student_t_tail(std::numeric_limits<double>::infinity(), 5) == 0);
    }

    TEST_CASE("bands of a mean and of a median, computed by hand") {
        const Estimate mean = mean_of({1, 2, 3, 4, 5}); // standard deviation √2.5, standard error √0.5
        CHECK(mean.value == Approx(3));
        CHECK(mean.relative_error == Approx(std::sqrt(0.5) / 3));
        CHECK(mean.dof == 4);
        CHECK(mean.high() == Approx(3 * std::exp(2.7764451 * std::sqrt(0.5) / 3)));
        CHECK(mean.low() * mean.high() == Approx(9));
        const Estimate median = median_of({std::exp(2.0), 1, std::exp(1.0)});
        CHECK(median.value == Approx(std::exp(1.0)));
        // The logarithms have a standard deviation of 1.
        CHECK(median.relative_error == Approx(std::sqrt(M_PI / 2) / std::sqrt(3.0)));
        CHECK(median_of({1, 9, 2, 4}).value == 3);
    }

    TEST_CASE("one measurement has no band, equal ones a narrow one, none no value") {
        CHECK(mean_of({2}).low() == 0);
        CHECK(mean_of({2}).high() == std::numeric_limits<double>::infinity());
        CHECK(mean_of({2, 2, 2}).low() == 2);
        CHECK(std::isnan(mean_of({}).value));
        CHECK(mean_of({0, 0}).relative_error == 0); // an image and a reference without noise
    }

    TEST_CASE("errors propagate to efficiency and ratio") {
        const Estimate mse{0.5, 0.03, 4}, seconds{4, 0.04, 4};
        const Estimate e = efficiency_of(mse, seconds);
        CHECK(e.value == Approx(0.5));
        CHECK(e.relative_error == Approx(0.05));
        // The Welch–Satterthwaite equation gives 0.0025² / (0.0009²/4 + 0.0016²/4).
        CHECK(e.dof == Approx(6.25e-6 * 4 / (0.81e-6 + 2.56e-6)));
        CHECK(ratio_of(seconds, mse).value == Approx(8));
        CHECK(p_value_above_one(ratio_of(mse, mse)) == 1);
        CHECK(p_value_above_one(ratio_of({2, 0.01, 4}, {1, 0.01, 4})) < 1e-6);
        CHECK(p_value_above_one(ratio_of({1.1, 0.1, 4}, {1, 0.1, 4})) > 0.2);
        CHECK(p_value_above_one(ratio_of({1.1, 0, 4}, {1, 0, 4})) == 0);       // no variance, but different values
        CHECK(p_value_above_one(ratio_of(mean_of({2}), mean_of({1}))) == 0.5); // the variance is unknown
    }
}

TEST_SUITE("statistical") {

    // The test draws 4000 bands from 5 log-normal values each (like times) and from 5 means of squares (like errors).
    // The miss rate of a 95 % band is within ±0.0138 of 5 %, except once in 16,000 times (four standard deviations of
    // the binomial). The delta method and the median's factor are approximate, so another percent is allowed.
    TEST_CASE("95 % bands hold the truth 95 % of the time") {
        std::mt19937 random(11);
        std::normal_distribution<double> normal;
        constexpr int kTrials = 4000;
        int mean_misses = 0, median_misses = 0;
        for (int i = 0; i < kTrials; ++i) {
            std::vector<double> errors, times;
            for (int k = 0; k < 5; ++k) {
                double square = 0;
                for (int j = 0; j < 100; ++j) {
                    const double v = normal(random);
                    square += v * v / 100;
                }
                errors.push_back(square);
                times.push_back(std::exp(0.1 * normal(random)));
            }
            const Estimate mean = mean_of(errors), median = median_of(times);
            mean_misses += mean.low() > 1 || mean.high() < 1;
            median_misses += median.low() > 1 || median.high() < 1;
        }
        CHECK(std::abs(mean_misses / double{kTrials} - 0.05) < 0.024);
        CHECK(std::abs(median_misses / double{kTrials} - 0.05) < 0.024);
    }
}

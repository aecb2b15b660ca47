#include "common/texture/noise.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>

using namespace duet;

namespace {

Vec3d random_point(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> place(-size, size);
    const double x = place(random), y = place(random), z = place(random);
    return {x, y, z};
}

double largest(Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// Returns the gradient at p by central differences.
Vec3d slope(Vec3d p, std::uint32_t seed = 0) {
    constexpr double h = 1e-5;
    const auto along = [&](Vec3d axis) {
        return (gradient_noise(p + axis * h, seed) - gradient_noise(p - axis * h, seed)) / (2 * h);
    };
    return {along({1, 0, 0}), along({0, 1, 0}), along({0, 0, 1})};
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("noise is 0 at lattice points, near and far, with one of twelve gradients") {
        std::mt19937 random(1);
        std::array<int, 27> seen{};
        for (int i = 0; i < 2000; ++i) {
            const Vec3d q = random_point(random, 1000), p{std::floor(q.x), std::floor(q.y), std::floor(q.z)};
            CHECK(gradient_noise(p) == 0);
            const Vec3d g = slope(p) * 1.0363538112118;
            const Vec3d rounded{std::round(g.x), std::round(g.y), std::round(g.z)};
            CHECK(largest(g - rounded) < 1e-6);
            CHECK(dot(rounded, rounded) == 2); // (±1, ±1, 0) and its permutations
            ++seen[static_cast<std::size_t>((rounded.x + 1) * 9 + (rounded.y + 1) * 3 + rounded.z + 1)];
        }
        // All 12 must be equally frequent: 2000/12 = 167 with a standard deviation of 12.4. The bound is 6.5 standard
        // deviations, so a false alarm has odds of 1e-9.
        CHECK(std::count_if(seen.begin(), seen.end(), [](int n) { return n > 0; }) == 12);
        for (const int n : seen)
            if (n > 0) CHECK(std::abs(n - 2000.0 / 12) < 6.5 * 12.4);
        CHECK(gradient_noise({0x1p40, -0x1p50, 0x1p31}) == 0);
    }

    TEST_CASE("noise stays within [-1, 1] and comes near its bounds") {
        std::mt19937 random(2);
        double least = 0, most = 0;
        for (int i = 0; i < 300000; ++i) {
            const double n = gradient_noise(random_point(random, 500));
            least = std::min(least, n);
            most = std::max(most, n);
        }
        CHECK(least >= -1);
        CHECK(most <= 1);
        CHECK(least < -0.75);
        CHECK(most > 0.75);
    }

    TEST_CASE("noise is smooth: values and slopes agree across cell borders, and everywhere") {
        std::mt19937 random(3);
        for (int i = 0; i < 3000; ++i) {
            Vec3d p = random_point(random, 100);
            if (i % 2 == 0) p[static_cast<std::size_t>(i / 2 % 3)] = std::floor(p.x); // on a cell boundary
            const Vec3d step = random_point(random, 1e-7);
            CHECK(std::abs(gradient_noise(p + step) - gradient_noise(p - step)) < 1e-6);
            CHECK(largest(slope(p + step * 100.0) - slope(p - step * 100.0)) < 1e-3);
        }
    }

    TEST_CASE("noise does not repeat within 2^16, and seeds are noises of their own") {
        const Vec3d p{0.3, 0.6, 0.4};
        for (const double period : {1.0, 2.0, 256.0, 4096.0, 65536.0, 1048576.0})
            for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
                int equal = 0;
                for (int i = 0; i < 20; ++i) {
                    const Vec3d q = p + Vec3d(i, 3 * i, -i);
                    equal += std::abs(gradient_noise(q + axis * period) - gradient_noise(q)) < 1e-6 ? 1 : 0;
                }
                CHECK(equal < 3);
            }
        int equal = 0;
        for (int i = 0; i < 20; ++i)
            equal += gradient_noise(p + Vec3d(i, 0, 0), 0) == gradient_noise(p + Vec3d(i, 0, 0), 1) ? 1 : 0;
        CHECK(equal < 3);
    }

    TEST_CASE("noise is finite however far away") {
        for (const double x : {1e15, 1e16, -1e30, 1e60, 1e77, 1e-300, -1e-300, -0.0})
            for (const double y : {0.5, -1e30, 1e-20}) {
                CHECK(std::abs(gradient_noise({x, y, -x})) <= 1);
                CHECK(std::abs(fractal_noise({x, y, -x}, 16)) <= 2);
            }
    }

    TEST_CASE("octaves: one is the noise itself, each further one adds half as much, and their zeros don't meet") {
        std::mt19937 random(5);
        for (int i = 0; i < 1000; ++i) {
            const Vec3d p = random_point(random, 30);
            CHECK(fractal_noise(p, 1) == gradient_noise(p));
            for (int n = 1; n < 10; ++n)
                CHECK(std::abs(fractal_noise(p, n + 1) - fractal_noise(p, n)) <= std::exp2(-n));
        }
        constexpr Vec3d kShift{0.618033988749895, 0.381966011250105, 0.236067977499790};
        for (const double size : {30.0, 1e15})
            for (int n = 1; n <= 16; ++n) {
                const Vec3d p = random_point(random, size);
                double sum = 0;
                for (int i = 0; i < n; ++i)
                    sum += std::exp2(-i) * gradient_noise(p * std::exp2(i) + kShift * static_cast<double>(i),
                                                          static_cast<std::uint32_t>(i));
                CHECK(fractal_noise(p, n) == sum);
            }
        int zeros = 0;
        for (int i = 0; i < 100; ++i) zeros += std::abs(fractal_noise({double(i), double(-i), 7}, 4)) < 1e-3 ? 1 : 0;
        CHECK(zeros < 5);
    }
}

TEST_SUITE("statistical") {
    TEST_CASE("noise has mean 0, cell by cell independent") {
        // Take one point in each of many cells. Cells that share no corner (every other one) are independent, so
        // |mean| < 5 standard errors fails by chance once in 1.7 million.
        std::mt19937 random(6);
        std::uniform_real_distribution<double> place(0, 1);
        double sum = 0, sum_of_squares = 0, fractal_sum = 0, fractal_squares = 0;
        int beyond = 0;
        constexpr int kSide = 40;
        for (int k = 0; k < kSide; ++k)
            for (int j = 0; j < kSide; ++j)
                for (int i = 0; i < kSide; ++i) {
                    const double x = place(random), y = place(random), z = place(random);
                    const double n = gradient_noise({2 * i + x, 2 * j + y, 2 * k + z});
                    sum += n;
                    sum_of_squares += n * n;
                    // The lattices of shifted octaves overlap. Points 4 apart share no lattice corner in any octave.
                    const double f = fractal_noise({4 * i + x, 4 * j + y, 4 * k + z}, 16);
                    fractal_sum += f;
                    fractal_squares += f * f;
                    beyond += std::abs(f) > 1 ? 1 : 0;
                }
        constexpr double kCount = double(kSide) * kSide * kSide;
        CHECK(std::abs(sum) / kCount < 5 * std::sqrt(sum_of_squares) / kCount);
        CHECK(std::abs(fractal_sum) / kCount < 5 * std::sqrt(fractal_squares) / kCount);
        // NoiseTexture clamps values beyond the range: fewer than 1 in 1,000 (measured 0.14 in 1,000, so 9 expected
        // here and 64 practically impossible).
        CHECK(beyond < kCount / 1000);
    }
}

// These tests check the uniformity of Sobol points and of their scrambling.
#include "common/sampling/hash.h"
#include "common/sampling/sobol.h"
#include "common/system/error.h"
#include "compare/stress/chi_squared.h"
#include "raytrace/sampling/sampler.h"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

using namespace duet;

namespace {

/// Returns the second Sobol dimension from its direction numbers: v₁ = ½, vᵢ = vᵢ₋₁ ⊕ vᵢ₋₁/2, from the primitive
/// polynomial x + 1 with m₁ = 1 (Joe and Kuo 2008; Sobol 1967). As in the textbooks, a digit of the index selects a
/// direction number.
std::uint32_t sobol_by_directions(std::uint32_t index) {
    std::uint32_t result = 0, direction = 0x80000000u;
    for (; index != 0; index >>= 1, direction ^= direction >> 1)
        if (index & 1u) result ^= direction;
    return result;
}

/// Returns points 0 to n−1 of one replicate.
std::vector<Vec2> replicate_points(SamplerKind kind, std::uint64_t seed, int replicate, int n,
                                   std::uint32_t dimension) {
    Sampler sampler(kind, seed, 2 * n, 2);
    std::vector<Vec2> points;
    for (int i = 0; i < n; ++i) {
        sampler.start(3, 5, static_cast<std::uint32_t>(2 * i + replicate));
        sampler.set_dimension(dimension);
        points.push_back(sampler.get_2d());
    }
    return points;
}

/// Counts the elementary intervals [a/2^i, (a+1)/2^i) × [b/2^(k−i), …) of area 2^−k that do not contain exactly one
/// of the 2^k points.
int faulty_elementary_intervals(const std::vector<Vec2>& points, int k) {
    int faults = 0;
    for (int i = 0; i <= k; ++i) {
        std::vector<int> count(points.size());
        for (const Vec2 p : points) {
            const auto column = static_cast<std::size_t>(std::ldexp(p.x, i));
            const auto row = static_cast<std::size_t>(std::ldexp(p.y, k - i));
            ++count[(row << i) + column];
        }
        for (const int c : count) faults += c != 1;
    }
    return faults;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("the fast second dimension is the one of the direction numbers") {
        for (std::uint32_t i = 0; i < 100'000; ++i) {
            const std::uint32_t index = i < 50'000 ? i : low_bits(mix_bits(i));
            REQUIRE(reverse_bits(sobol_second(index)) == sobol_by_directions(index));
        }
    }

    TEST_CASE("Owen scrambling is a bijection that keeps digits' common prefixes") {
        // Two numbers that agree in exactly their first k digits (the lowest bits after reversal) must agree in
        // exactly as many after scrambling.
        for (std::uint32_t trial = 0; trial < 2000; ++trial) {
            const std::uint32_t seed = low_bits(mix_bits(trial)), a = high_bits(mix_bits(trial + 77));
            for (std::uint32_t k = 0; k < 32; ++k) {
                const std::uint32_t b = a ^ (1u << k) ^ (k < 31 ? low_bits(mix_bits(trial * 32 + k)) << (k + 1) : 0u);
                const std::uint32_t difference = owen_scramble(a, seed) ^ owen_scramble(b, seed);
                REQUIRE((difference & ((2u << k) - 1u)) == (1u << k));
            }
        }
    }

    TEST_CASE("every pair of dimensions of every replicate is a (0, m, 2)-net at every power of two") {
        for (int replicate = 0; replicate < 2; ++replicate)
            for (const std::uint32_t dimension : {0u, 2u, 5u, 40u})
                for (int k = 0; k <= 12; ++k) {
                    CAPTURE(replicate);
                    CAPTURE(dimension);
                    CAPTURE(k);
                    const auto points = replicate_points(SamplerKind::kSobol, 9, replicate, 1 << k, dimension);
                    CHECK(faulty_elementary_intervals(points, k) == 0);
                }
    }

    TEST_CASE("blue noise: aligned squares of pixels are nets together, one sample each or many") {
        for (const int spp : {2, 8, 6})
            for (const int size : {1, 2, 4, 16})
                for (int replicate = 0; replicate < 2; ++replicate)
                    for (const std::uint32_t dimension : {0u, 8u, 18u}) {
                        CAPTURE(spp);
                        CAPTURE(size);
                        // If the sample count is not a power of two, the first samples of each pixel form separate
                        // nets.
                        const int samples = spp == 6 ? 2 : spp / 2;
                        if (spp == 6 && size > 1) continue;
                        std::vector<Vec2> points;
                        Sampler s(SamplerKind::kBlueNoise, 4, spp, 2);
                        for (int y = 0; y < size; ++y)
                            for (int x = 0; x < size; ++x)
                                for (int i = 0; i < samples; ++i) {
                                    s.start(x + 2 * size, y + size, static_cast<std::uint32_t>(2 * i + replicate));
                                    s.set_dimension(dimension);
                                    points.push_back(s.get_2d());
                                }
                        const int k = static_cast<int>(std::bit_width(points.size())) - 1;
                        CHECK(faulty_elementary_intervals(points, k) == 0);
                    }
    }

    TEST_CASE("the second of a pair of numbers is stratified at every power of two") {
        for (const SamplerKind kind : {SamplerKind::kSobol, SamplerKind::kBlueNoise, SamplerKind::kStratified})
            for (int replicate = 0; replicate < 2; ++replicate)
                for (int n = 1; n <= 1024; n *= 2) {
                    Sampler sampler(kind, 1, 2 * n, 2);
                    std::set<int> cells;
                    for (int i = 0; i < n; ++i) {
                        sampler.start(0, 0, static_cast<std::uint32_t>(2 * i + replicate));
                        cells.insert(static_cast<int>(sampler.get_2d().y * static_cast<float>(n)));
                    }
                    CHECK(static_cast<int>(cells.size()) == n);
                }
    }

    TEST_CASE("stratified pairs: one point a row, one a fine column, one a coarse cell, for any count") {
        for (const int n : {1, 2, 3, 5, 7, 12, 16, 17, 36, 100, 127}) {
            CAPTURE(n);
            const auto points = replicate_points(SamplerKind::kStratified, 4, 1, n, 6);
            const int columns = static_cast<int>(std::sqrt(n)), rows = (n + columns - 1) / columns;
            std::set<int> fine_rows, fine_columns;
            std::set<std::pair<int, int>> cells;
            for (const Vec2 p : points) {
                fine_rows.insert(static_cast<int>(p.y * static_cast<float>(n)));
                fine_columns.insert(static_cast<int>(p.x * static_cast<float>(columns * rows)));
                const int rank =
                    static_cast<int>(p.y * static_cast<float>(n)); // each row of cells holds `columns` points
                cells.insert({static_cast<int>(p.x * static_cast<float>(columns)), rank / columns});
            }
            CHECK(static_cast<int>(fine_rows.size()) == n);
            CHECK(static_cast<int>(fine_columns.size()) == n);
            CHECK(static_cast<int>(cells.size()) == n);
        }
    }

    TEST_CASE("permute is a permutation of any count, and keys differ") {
        for (const std::uint32_t n : {1u, 2u, 3u, 5u, 8u, 100u, 1000u}) {
            std::set<std::uint32_t> images;
            std::uint32_t moved = 0;
            for (std::uint32_t i = 0; i < n; ++i) {
                images.insert(permute(i, n, 42));
                moved += permute(i, n, 42) != permute(i, n, 43);
            }
            CHECK(images.size() == n);
            CHECK(*images.rbegin() == n - 1);
            if (n >= 100) CHECK(moved > n / 2);
        }
    }
}

TEST_SUITE("statistical") {
    // Each case has fixed seeds and a significance of 1e-4, so a correct change of the hashes breaks one case in
    // 10,000.

    TEST_CASE(
        "each digit is flipped half of the time, whatever the earlier digits: the scrambling is Owen's, not an XOR") {
        // For two different prefixes, the flips of the next digit must be independent: the 4 outcomes are equally
        // likely over the seeds.
        int tests = 0;
        double worst = 1;
        std::string account;
        for (std::uint32_t digit = 0; digit < 12; ++digit)
            for (std::uint32_t a = 0; a < 6; ++a) {
                const std::uint32_t prefix_a = low_bits(mix_bits(a + 1)) & ((1u << digit) - 1u);
                const std::uint32_t prefix_b = digit == 0 ? 0 : prefix_a ^ (1u << (a % digit));
                std::vector<double> count(digit == 0 ? 2 : 4),
                    expected(count.size(), 40'000.0 / static_cast<double>(count.size()));
                for (std::uint32_t trial = 0; trial < 40'000; ++trial) {
                    const std::uint32_t seed = high_bits(mix_bits(trial + 1));
                    const std::size_t flip_a = (owen_scramble(prefix_a, seed) >> digit) & 1u;
                    const std::size_t flip_b = (owen_scramble(prefix_b, seed) >> digit) & 1u;
                    ++count[digit == 0 ? flip_a : 2 * flip_a + flip_b];
                }
                const auto result = compare::chi_squared(count, expected);
                ++tests;
                if (result.p_value < worst) {
                    worst = result.p_value;
                    account =
                        message("digit ", digit, ", prefixes ", prefix_a, " and ", prefix_b, ": ", result.details);
                }
            }
        CHECK_MESSAGE(worst > compare::sidak_level(1e-4, tests), account);
    }

    TEST_CASE("scrambled Sobol points integrate a smooth function far better than independent ones, without bias") {
        // The integrand is a Gaussian bump with the integral (√π/2·erf(1))².
        const double side = 0.5 * std::sqrt(kPiDouble) * std::erf(1.0), truth = side * side;
        const auto f = [](Vec2 u) {
            return std::exp(-static_cast<double>(u.x * u.x) - static_cast<double>(u.y * u.y));
        };
        constexpr int kPixels = 400, kPoints = 256;
        double mean_square[3]{}, mean[3]{};
        const SamplerKind kinds[] = {SamplerKind::kSobol, SamplerKind::kStratified, SamplerKind::kIndependent};
        for (int k = 0; k < 3; ++k)
            for (int pixel = 0; pixel < kPixels; ++pixel) {
                Sampler s(kinds[k], 11, 2 * kPoints, 2);
                double sum = 0;
                for (std::uint32_t i = 0; i < kPoints; ++i) {
                    s.start(pixel, 0, 2 * i);
                    s.set_dimension(4);
                    sum += f(s.get_2d());
                }
                const double error = sum / kPoints - truth;
                mean[k] += error / kPixels;
                mean_square[k] += error * error / kPixels;
            }
        for (int k = 0; k < 3; ++k) { // a t-test on 400 pixels: 4.5 standard errors, odds 1e-5
            CAPTURE(sampler_name(kinds[k]));
            CHECK(std::abs(mean[k]) < 4.5 * std::sqrt(mean_square[k] / kPixels));
        }
        // Independent samples have variance σ²/n. Owen-scrambled nets have O(n⁻³ log n) for smooth f (Owen 1997),
        // which is thousands of times less here.
        CHECK(mean_square[0] * 3000 < mean_square[2]);
        CHECK(mean_square[1] * 30 < mean_square[2]);
    }
}

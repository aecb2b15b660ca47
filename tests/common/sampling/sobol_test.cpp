// Sobol points, their scrambling, and the sampler built on them.
#include "common/sampling/hash.h"
#include "common/sampling/sampler.h"
#include "common/sampling/sobol.h"
#include "common/system/error.h"
#include "compare/stress/chi_squared.h"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

using namespace duet;

namespace {

/// The second dimension by its direction numbers: v₁ = ½, vᵢ = vᵢ₋₁ ⊕ vᵢ₋₁/2, from the primitive polynomial x + 1 with
/// m₁ = 1 (Joe and Kuo 2008; Sobol 1967). As in the textbooks: a digit of the index chooses a direction number.
std::uint32_t sobol_by_directions(std::uint32_t index) {
    std::uint32_t result = 0, direction = 0x80000000u;
    for (; index != 0; index >>= 1, direction ^= direction >> 1)
        if (index & 1u) result ^= direction;
    return result;
}

/// Points 0 … n−1 of one replicate.
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

/// How many elementary intervals [a/2^i, (a+1)/2^i) × [b/2^(k−i), …) of area 2^−k do not hold just one of the 2^k
/// points.
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

constexpr SamplerKind kAll[] = {SamplerKind::kSobol, SamplerKind::kBlueNoise, SamplerKind::kStratified,
                                SamplerKind::kIndependent, SamplerKind::kCenter};

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("the fast second dimension is the one of the direction numbers") {
        for (std::uint32_t i = 0; i < 100'000; ++i) {
            const std::uint32_t index = i < 50'000 ? i : low_bits(mix_bits(i));
            REQUIRE(reverse_bits(sobol_second(index)) == sobol_by_directions(index));
        }
    }

    TEST_CASE("Owen scrambling is a bijection that keeps digits' common prefixes") {
        // Numbers that agree in their first k digits (reversed: lowest bits) agree after scrambling in just as many.
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

    TEST_CASE("without replicates all samples of a pixel are points of the first one's sequence") {
        for (const SamplerKind kind : kAll)
            for (std::uint32_t index = 0; index < 16; ++index) {
                Sampler together(kind, 9, 16), replicates(kind, 9, 32, 2);
                together.start(3, 5, index);
                replicates.start(3, 5, 2 * index);
                CHECK(together.get_2d() == replicates.get_2d());
                CHECK(together.get_1d() == replicates.get_1d());
            }
    }

    TEST_CASE("blue noise: aligned squares of pixels are nets together, one sample each or many") {
        for (const int spp : {2, 8, 6})
            for (const int size : {1, 2, 4, 16})
                for (int replicate = 0; replicate < 2; ++replicate)
                    for (const std::uint32_t dimension : {0u, 8u, 18u}) {
                        CAPTURE(spp);
                        CAPTURE(size);
                        // Of a count that is no power of two the first samples of each pixel are nets of their own.
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

    TEST_CASE("one dimension is stratified at every power of two") {
        for (const SamplerKind kind : {SamplerKind::kSobol, SamplerKind::kBlueNoise, SamplerKind::kStratified})
            for (int replicate = 0; replicate < 2; ++replicate)
                for (int n = 1; n <= 1024; n *= 2) {
                    Sampler sampler(kind, 1, 2 * n, 2);
                    std::set<int> cells;
                    for (int i = 0; i < n; ++i) {
                        sampler.start(0, 0, static_cast<std::uint32_t>(2 * i + replicate));
                        cells.insert(static_cast<int>(sampler.get_1d() * static_cast<float>(n)));
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
                    static_cast<int>(p.y * static_cast<float>(n)); // rows of cells hold `columns` points each
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

    TEST_CASE("numbers are a function of seed, pixel, sample and dimension, whatever was drawn before") {
        for (const SamplerKind kind : kAll) {
            Sampler a(kind, 7, 64, 2), b(kind, 7, 64, 2);
            a.start(10, 20, 33);
            for (int i = 0; i < 9; ++i) a.get_1d();
            a.start(1, 2, 3);
            a.set_dimension(8);
            b.start(1, 2, 3);
            while (b.dimension() < 8) b.get_2d();
            CHECK(a.get_2d() == b.get_2d());
            CHECK(a.dimension() == 10);
            CHECK(a.get_1d() == b.get_1d());

            // … and of each of them
            const auto draw = [&](std::uint64_t seed, int x, int y, std::uint32_t index, std::uint32_t dimension) {
                Sampler s(kind, seed, 64, 2);
                s.start(x, y, index);
                s.set_dimension(dimension);
                return s.get_2d();
            };
            const Vec2 base = draw(7, 1, 2, 3, 8);
            CHECK(base != draw(8, 1, 2, 3, 8));
            CHECK(base != draw(7, 2, 2, 3, 8));
            CHECK(base != draw(7, 1, 3, 3, 8));
            CHECK(base != draw(7, 2, 1, 3, 8));
            CHECK(base != draw(7, 1, 2, 4, 8)); // the other replicate
            CHECK(base != draw(7, 1, 2, 5, 8)); // the next point
            CHECK(base != draw(7, 1, 2, 3, 10));
        }
    }

    TEST_CASE("every number lies in [0, 1), also beyond the promised count and far out in index") {
        for (const SamplerKind kind : kAll) {
            Sampler sampler(kind, 0, 3);
            for (std::uint32_t i = 0; i < 20'000; ++i) {
                sampler.start(-5, 2'000'000, i < 10'000 ? i : ~i);
                const float a = sampler.get_1d();
                const Vec2 b = sampler.get_2d();
                REQUIRE((a >= 0 && a < 1 && b.x >= 0 && b.x < 1 && b.y >= 0 && b.y < 1));
            }
        }
        CHECK(unit_float(0xffffffffu) == kOneMinusEpsilon);
        CHECK(unit_float(0) == 0);
    }

    TEST_CASE("a block of eight is four pairs, and ends after them") {
        for (const SamplerKind kind : kAll)
            for (const std::uint32_t dimension : {0u, 8u, 24u, 8u * 65u})
                for (std::uint32_t index = 0; index < 50; ++index) {
                    Sampler block(kind, 3, 16), pairs(kind, 3, 16);
                    block.start(7, -2, index);
                    pairs.start(7, -2, index);
                    block.set_dimension(dimension);
                    pairs.set_dimension(dimension);
                    const auto numbers = block.get_block();
                    for (std::size_t i = 0; i < numbers.size(); i += 2)
                        REQUIRE(pairs.get_2d() == Vec2(numbers[i], numbers[i + 1]));
                    REQUIRE(block.dimension() == pairs.dimension());
                }
    }

    TEST_CASE("the blocks of two samplers at once are those of each") {
        for (const SamplerKind kind : kAll)
            for (std::uint32_t index = 0; index < 40; ++index) {
                std::array<Sampler, 4> s{Sampler(kind, 3, 16), Sampler(kind, 3, 16), Sampler(kind, 3, 16),
                                         Sampler(kind, 3, 16)};
                for (std::size_t i = 0; i < 4; ++i) {
                    s[i].start(static_cast<int>(7 + (i & 1)), -2, index + static_cast<std::uint32_t>(i & 1));
                    s[i].set_dimension(16);
                }
                const auto [first, second] = Sampler::get_blocks(s[0], s[1]);
                CHECK(first == s[2].get_block());
                CHECK(second == s[3].get_block());
                CHECK(s[0].dimension() == s[2].dimension());
                CHECK(s[1].dimension() == s[3].dimension());
            }
    }

    TEST_CASE("center: the middle of pixel and lens, time 0, all else as Sobol") {
        Sampler center(SamplerKind::kCenter, 5, 16), sobol(SamplerKind::kSobol, 5, 16);
        center.start(4, 4, 9);
        sobol.start(4, 4, 9);
        const CameraNumbers middle = center.camera_numbers({true, true}), spread = sobol.camera_numbers({true, true});
        CHECK(middle.pixel == Vec2(0.5f, 0.5f));
        CHECK(middle.lens == Vec2(0.5f, 0.5f));
        CHECK(middle.time == 0);
        CHECK(center.get_2d() == spread.pixel);
        CHECK(sobol.get_2d() == spread.pixel);
        CHECK(sobol.get_2d() == spread.lens);
        CHECK(sobol.get_1d() == spread.time);
    }

    TEST_CASE("what the camera does not ask for moves no other number") {
        Sampler sampler(SamplerKind::kSobol, 5, 16);
        sampler.start(4, 4, 9);
        const CameraNumbers all = sampler.camera_numbers({true, true}), none = sampler.camera_numbers({});
        CHECK(none.pixel == all.pixel);
        CHECK(none.lens == Vec2(0.5f, 0.5f));
        CHECK(none.time == 0);
        CHECK(sampler.camera_numbers({true, false}).lens == all.lens);
        CHECK(sampler.camera_numbers({false, true}).time == all.time);
    }

    TEST_CASE("the pairs of many samplers at once are those of each, in any number and order") {
        for (const SamplerKind kind : kAll)
            for (const std::size_t count : {1u, 5u, 16u, 17u, 70u}) {
                std::vector<Sampler> samplers(count, Sampler(kind, 3, 16, 2));
                std::vector<std::uint32_t> which;
                for (std::uint32_t i = 0; i < count; ++i) {
                    samplers[i].start(static_cast<int>(i % 7), -2, i / 3);
                    if (i % 3 != 1) which.push_back(static_cast<std::uint32_t>(count) - 1 - i);
                }
                constexpr std::array<std::uint32_t, 2> kDimensions{8, 26};
                std::vector<Vec2> all(2 * count), some(2 * which.size());
                Sampler::pairs(samplers, kDimensions, all);
                Sampler::pairs(samplers, which, kDimensions, some);
                for (std::size_t d = 0; d < 2; ++d)
                    for (std::size_t k = 0; k < which.size(); ++k)
                        CHECK(some[d * which.size() + k] == all[d * count + which[k]]);
                for (std::size_t i = 0; i < count; ++i) {
                    CHECK(samplers[i].dimension() == 0);
                    for (std::size_t d = 0; d < 2; ++d) {
                        samplers[i].set_dimension(kDimensions[d]);
                        CHECK(samplers[i].get_2d() == all[d * count + i]);
                    }
                }
            }
    }

    TEST_CASE("names") {
        for (const SamplerKind kind : kAll) CHECK(sampler_kind(sampler_name(kind)) == kind);
        CHECK_THROWS_AS(sampler_kind("Sobol"), Error);
        CHECK_THROWS_AS(sampler_kind(""), Error);
    }
}

TEST_SUITE("statistical") {
    // Each case has fixed seeds; its significance is 1e-4, so a correct change of hashes breaks one case in 10,000.

    TEST_CASE("pairs are uniform over pixels, samples and dimensions") {
        constexpr int kBins = 16, kTests = 12;
        int test = 0;
        for (const SamplerKind kind : {SamplerKind::kSobol, SamplerKind::kStratified, SamplerKind::kIndependent})
            for (int variant = 0; variant < 4; ++variant, ++test) {
                // One sample of each of many pixels: within a pixel the points are more even than random, across they
                // are independent.
                std::vector<double> count(kBins * kBins), expected(kBins * kBins, 65536.0 / (kBins * kBins));
                for (int y = 0; y < 256; ++y)
                    for (int x = 0; x < 256; ++x) {
                        Sampler s(kind, static_cast<std::uint64_t>(test), 14, 2);
                        s.start(x, y, static_cast<std::uint32_t>(variant * 3));
                        s.set_dimension(static_cast<std::uint32_t>(variant * 7));
                        const Vec2 u = s.get_2d();
                        ++count[static_cast<std::size_t>(u.y * kBins) * kBins + static_cast<std::size_t>(u.x * kBins)];
                    }
                const auto result = compare::chi_squared(count, expected);
                CAPTURE(sampler_name(kind));
                CAPTURE(variant);
                CHECK_MESSAGE(result.p_value > compare::sidak_level(1e-4, kTests), result.account);
            }
    }

    TEST_CASE("two numbers of neighbouring seeds, pixels, samples, replicates or dimensions are independent") {
        struct Key {
            std::uint64_t seed = 0;
            int x = 0;
            std::uint32_t index = 0, dimension = 0;
        };
        const Key keys[] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {0, 0, 0, 2}, {0, 0, 3, 4}};
        constexpr int kBins = 16;
        for (const SamplerKind kind : {SamplerKind::kSobol, SamplerKind::kStratified, SamplerKind::kIndependent})
            for (const Key& key : keys) {
                std::vector<double> count(kBins * kBins), expected(kBins * kBins, 65536.0 / (kBins * kBins));
                for (int y = 0; y < 256; ++y)
                    for (int x = 0; x < 256; ++x) {
                        const auto draw = [&](const Key& k) {
                            Sampler s(kind, 100 + k.seed, 16, 2);
                            s.start(2 * x + k.x, y, k.index);
                            s.set_dimension(20 + k.dimension);
                            return s.get_1d();
                        };
                        ++count[static_cast<std::size_t>(draw({}) * kBins) * kBins +
                                static_cast<std::size_t>(draw(key) * kBins)];
                    }
                const auto result = compare::chi_squared(count, expected);
                CAPTURE(sampler_name(kind));
                CAPTURE(key.seed);
                CAPTURE(key.x);
                CAPTURE(key.index);
                CAPTURE(key.dimension);
                CHECK_MESSAGE(result.p_value > compare::sidak_level(1e-4, 18), result.account);
            }
    }

    TEST_CASE(
        "each digit is flipped half of the time, whatever the earlier digits: the scrambling is Owen's, not an XOR") {
        // For two prefixes that differ, the flips of the digit after them must be independent: 4 outcomes of equal odds
        // over seeds.
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
                        message("digit ", digit, ", prefixes ", prefix_a, " and ", prefix_b, ": ", result.account);
                }
            }
        CHECK_MESSAGE(worst > compare::sidak_level(1e-4, tests), account);
    }

    TEST_CASE("scrambled Sobol points integrate a smooth function far better than independent ones, without bias") {
        // f = Gaussian-like bump, ∫ = (√π/2·erf(1))²
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
        // Independent: σ²/n. Owen-scrambled nets: O(n⁻³ log n) for smooth f (Owen 1997): thousands of times less here.
        CHECK(mean_square[0] * 3000 < mean_square[2]);
        CHECK(mean_square[1] * 30 < mean_square[2]);
    }
}

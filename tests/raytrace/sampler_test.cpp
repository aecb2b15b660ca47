// These tests check what the random samples depend on, their distribution, and their independence.
#include "common/sampling/hash.h"
#include "common/system/error.h"
#include "compare/stress/chi_squared.h"
#include "raytrace/sampling/sampler.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

using namespace duet;

namespace {

constexpr SamplerKind kAll[] = {SamplerKind::kSobol, SamplerKind::kBlueNoise, SamplerKind::kStratified,
                                SamplerKind::kIndependent, SamplerKind::kCenter};

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("without replicates all samples of a pixel are points of the first one's sequence") {
        for (const SamplerKind kind : kAll)
            for (std::uint32_t index = 0; index < 16; ++index) {
                Sampler together(kind, 9, 16), replicates(kind, 9, 32, 2);
                together.start(3, 5, index);
                replicates.start(3, 5, 2 * index);
                CHECK(together.get_2d() == replicates.get_2d());
                CHECK(together.get_2d() == replicates.get_2d());
            }
    }

    TEST_CASE("numbers are a function of seed, pixel, sample and dimension, whatever was drawn before") {
        for (const SamplerKind kind : kAll) {
            Sampler a(kind, 7, 64, 2), b(kind, 7, 64, 2);
            a.start(10, 20, 33);
            for (int i = 0; i < 9; ++i) a.get_2d();
            a.start(1, 2, 3);
            a.set_dimension(8);
            b.start(1, 2, 3);
            while (b.dimension() < 8) b.get_2d();
            CHECK(a.get_2d() == b.get_2d());
            CHECK(a.dimension() == 10);
            CHECK(a.get_2d() == b.get_2d());

            // The number must depend on each argument.
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
                const float a = sampler.get_2d().x;
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

    TEST_CASE("center: the middle of pixel and lens, time 0, all else as Sobol") {
        Sampler center(SamplerKind::kCenter, 5, 16), sobol(SamplerKind::kSobol, 5, 16);
        center.start(4, 4, 9);
        sobol.start(4, 4, 9);
        const CameraRaySample middle = center.camera_ray_samples({true, true}),
                              spread = sobol.camera_ray_samples({true, true});
        CHECK(middle.pixel == Vec2(0.5f, 0.5f));
        CHECK(middle.lens == Vec2(0.5f, 0.5f));
        CHECK(middle.time == 0);
        CHECK(center.get_2d() == spread.pixel);
        CHECK(sobol.get_2d() == spread.pixel);
        CHECK(sobol.get_2d() == spread.lens);
        CHECK(sobol.get_2d().x == spread.time);
    }

    TEST_CASE("what the camera does not ask for moves no other number") {
        Sampler sampler(SamplerKind::kSobol, 5, 16);
        sampler.start(4, 4, 9);
        const CameraRaySample all = sampler.camera_ray_samples({true, true}), none = sampler.camera_ray_samples({});
        CHECK(none.pixel == all.pixel);
        CHECK(none.lens == Vec2(0.5f, 0.5f));
        CHECK(none.time == 0);
        CHECK(sampler.camera_ray_samples({true, false}).lens == all.lens);
        CHECK(sampler.camera_ray_samples({false, true}).time == all.time);
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
                Sampler::get_2d_batch(samplers, kDimensions, all);
                Sampler::get_2d_batch(samplers, which, kDimensions, some);
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

    // Each case has fixed seeds and a significance of 1e-4, so a correct change of the hashes breaks one case in
    // 10,000.

    TEST_CASE("pairs are uniform over pixels, samples and dimensions") {
        constexpr int kBins = 16, kTests = 12;
        int test = 0;
        for (const SamplerKind kind : {SamplerKind::kSobol, SamplerKind::kStratified, SamplerKind::kIndependent})
            for (int variant = 0; variant < 4; ++variant, ++test) {
                // Take one sample from each of many pixels. Samples of one pixel are more uniform than random ones,
                // but samples of different pixels are independent.
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
                CHECK_MESSAGE(result.p_value > compare::sidak_level(1e-4, kTests), result.details);
            }
    }

    TEST_CASE("two numbers of neighboring seeds, pixels, samples, replicates or dimensions are independent") {
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
                            return s.get_2d().x;
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
                CHECK_MESSAGE(result.p_value > compare::sidak_level(1e-4, 18), result.details);
            }
    }
}

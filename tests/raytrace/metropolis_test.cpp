// These tests check Metropolis light transport: the moves of a primary sample, and that no part of the image is
// brighter or darker than in bidirectional path tracing.
#include "raytrace/sampling/primary_sample.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace duet;
using namespace duet::raytrace;

namespace {

constexpr auto kBlock = static_cast<std::uint32_t>(Sampler::kBlock);

PrimarySample start(std::uint64_t seed) {
    Sampler sampler(SamplerKind::kIndependent, seed, 1);
    sampler.start(0, 0, 3);
    const Sampler::Block first = sampler.get_block();
    return {sampler, first, seed};
}

Sampler::Block read(PrimarySample& sample, std::uint32_t block) {
    sample.set_dimension(block * kBlock);
    return sample.get_block();
}

// Returns two rooms beside each other. An area light lights the right one, and the left one through a gap alone. A
// glass ball stands in the light.
Scene two_rooms() {
    SceneBuilder builder;
    const std::uint32_t wall = builder.material(Diffuse{{Rgb(0.7f, 0.6f, 0.5f)}});
    builder.add(quad({-3, 0, 2}, {6, 0, 0}, {0, 0, -4}), wall);
    builder.add(quad({-3, 0, -2}, {6, 0, 0}, {0, 3, 0}), wall);
    builder.add(quad({0, 0, -1.2f}, {0, 0, 3.2f}, {0, 3, 0}), wall);
    builder.add(Sphere{{1.3f, 0.6f, 0.4f}, 0.6f}, builder.material(Dielectric{}));
    builder.add(quad({1, 2.9f, -0.5f}, {0.5f, 0, 0}, {0, 0, 0.5f}), builder.material(Emissive{Rgb(40.0f)}));
    builder.scene.camera.eye = {0, 1.5, 8};
    builder.scene.camera.look_at = {0, 1.3, 0};
    builder.scene.camera.fov_degrees = 40;
    return builder.finish();
}

constexpr int kParts = 9;
/// Holds the green light of each ninth of an image: the mean over independent seeds, and its standard error.
using Parts = std::array<Estimate, kParts>;

Parts estimate_parts(const Scene& scene, PathTracerSettings settings, int seeds) {
    constexpr int kSide = 24;
    std::array<double, kParts> sums{}, squares{};
    for (int seed = 0; seed < seeds; ++seed) {
        settings.seed = static_cast<std::uint64_t>(seed + 1);
        const ImageRgb image = render_scene(scene, kSide, settings).radiance;
        std::array<double, kParts> means{};
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                means[static_cast<std::size_t>(y * 3 / kSide * 3 + x * 3 / kSide)] +=
                    static_cast<double>(image(x, y).g) * kParts / (kSide * kSide);
        for (std::size_t i = 0; i < kParts; ++i) sums[i] += means[i], squares[i] += means[i] * means[i];
    }
    Parts parts;
    for (std::size_t i = 0; i < kParts; ++i) {
        const double mean = sums[i] / seeds, variance = squares[i] / seeds - mean * mean;
        parts[i] = {mean, std::sqrt(std::max(variance, 0.0) / (seeds - 1))};
    }
    return parts;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a primary sample starts at a sampler's point, to which rejected proposals return") {
        PrimarySample sample = start(7);
        CHECK(sample.sample() == 3);
        Sampler sampler(SamplerKind::kIndependent, 7, 1);
        sampler.start(0, 0, 3);
        for (std::uint32_t block = 0; block < 3; ++block) {
            const Sampler::Block expected = sampler.get_block();
            if (block != 1) CHECK(read(sample, block) == expected);
        }
        const Sampler::Block first = read(sample, 0), third = read(sample, 2);
        CHECK(read(sample, 0) == first);
        for (int i = 0; i < 50; ++i) {
            sample.propose();
            CHECK(read(sample, 0) != first);
            read(sample, 1);
            sample.reject();
        }
        CHECK(read(sample, 0) == first);
        CHECK(read(sample, 2) == third);
    }

    // A number that is read again after n small steps has moved by sqrt(n) times the deviation of one. The bounds are
    // six standard errors of a deviation from 8 · 1,000 numbers.
    TEST_CASE("small steps have their deviation, however many were missed") {
        for (const int missed : {1, 4, 9}) {
            double squares = 0;
            int numbers = 0;
            for (std::uint64_t seed = 0; numbers < 8000; ++seed) {
                PrimarySample sample = start(seed);
                const Sampler::Block before = read(sample, 0);
                for (int i = 0; i < missed; ++i) sample.propose(), sample.accept();
                const Sampler::Block after = read(sample, 0);
                std::array<double, Sampler::kBlock> moves{};
                double longest = 0;
                for (std::size_t i = 0; i < moves.size(); ++i) {
                    const double move = static_cast<double>(after[i]) - static_cast<double>(before[i]);
                    moves[i] = move - std::round(move); // the interval is a circle
                    longest = std::max(longest, std::abs(moves[i]));
                }
                if (longest > 0.2) continue; // there was a large step; by small ones this is 6.6 deviations or more
                for (const double move : moves) squares += move * move, ++numbers;
            }
            const double expected = static_cast<double>(PrimarySample::kDeviation) * std::sqrt(missed);
            const double tolerance = 6 * expected / std::sqrt(2.0 * numbers) + 0.01 * expected;
            CHECK(std::abs(std::sqrt(squares / numbers) - expected) < tolerance);
        }
    }

    TEST_CASE("numbers stay in [0, 1) and spread evenly over it") {
        PrimarySample sample = start(11);
        std::array<int, 4> counts{};
        for (int i = 0; i < 4000; ++i) {
            sample.propose();
            for (const float u : read(sample, static_cast<std::uint32_t>(i % 3))) {
                REQUIRE(u >= 0);
                REQUIRE(u < 1);
                ++counts[static_cast<std::size_t>(4 * u)];
            }
            sample.accept();
        }
        // Each of some 600 large steps gives eight independent numbers or more. The bound is six deviations.
        for (const int count : counts) CHECK(std::abs(count / 32000.0 - 0.25) < 6 * std::sqrt(0.1875 / 4800));
    }

    TEST_CASE("an image without light is black, and auxiliary images are those of the camera rays") {
        SceneBuilder builder;
        builder.add(Sphere{{0, 0, 0}, 1}, builder.material(Diffuse{}));
        const Scene scene = builder.finish();
        PathTracerSettings settings;
        settings.samples_per_pixel = 2;
        settings.aovs.depth = true;
        const Rendering path = render_scene(scene, 20, settings);
        settings.integrator = Integrator::kMetropolis;
        const Rendering metropolis = render_scene(scene, 20, settings);
        for (const Rgb& pixel : metropolis.radiance) CHECK(is_black(pixel));
        for (std::size_t i = 0; i < path.depth.size(); ++i) {
            if (std::isinf(path.depth[i]) || std::isinf(metropolis.depth[i])) continue; // rays differ by rounding
            CHECK(path.depth[i] == doctest::Approx(metropolis.depth[i]).epsilon(1e-4));
        }
    }
}

TEST_SUITE("statistical") {
    // A path of number u below 1/2 reads another number v, and is bright where that is below 1/2, too. Both halves of u
    // bring the same light. Chains start in equilibrium, in which they must stay: half of their steps are below 1/2.
    // The bound is six standard errors over chains, which is exceeded by chance once in 5e8 times.
    TEST_CASE("chains stay in equilibrium where paths read different numbers") {
        constexpr int kChains = 16000, kSteps = 1000;
        const auto light = [](PrimarySample& sample) {
            if (read(sample, 0)[0] >= 0.5f) return 1.0f;
            return read(sample, 1)[0] < 0.5f ? 2.0f : 0.0f;
        };
        Sampler uniform(SamplerKind::kIndependent, 99, 1);
        uniform.start(0, 0, 0);
        double sum = 0, squares = 0;
        int chains = 0;
        for (std::uint64_t seed = 0; chains < kChains; ++seed) {
            PrimarySample sample = start(seed);
            float current = light(sample);
            if (2 * uniform.get_2d().x >= current) continue; // starts have a density in proportion to their light
            double below = 0;
            for (int step = 0; step < kSteps; ++step) {
                sample.propose();
                const float proposal = light(sample);
                if (uniform.get_2d().x * current < proposal)
                    sample.accept(), current = proposal;
                else
                    sample.reject();
                below += read(sample, 0)[0] < 0.5f ? 1.0 / kSteps : 0;
            }
            sum += below, squares += below * below, ++chains;
        }
        const double mean = sum / chains, error = std::sqrt((squares / chains - mean * mean) / chains);
        CAPTURE(mean);
        CAPTURE(error);
        CHECK(std::abs(mean - 0.5) < 6 * error);
        CHECK(6 * error < 0.006);
    }

    // The bound is six standard errors of the difference over twenty seeds each, which is exceeded by chance once in
    // 2,000,000 comparisons.
    TEST_CASE("each part of the image converges to that of bidirectional path tracing") {
        PathTracerSettings settings;
        settings.max_depth = 4;
        settings.integrator = Integrator::kBidirectional;
        settings.samples_per_pixel = 128;
        const Parts joined = estimate_parts(two_rooms(), settings, 20);
        settings.integrator = Integrator::kMetropolis;
        settings.samples_per_pixel = 48;
        const Parts metropolis = estimate_parts(two_rooms(), settings, 20);
        double mean = 0;
        for (const Estimate& part : joined) mean += part.mean / kParts;
        for (std::size_t i = 0; i < kParts; ++i) {
            CAPTURE(i);
            check_equal_means(joined[i], metropolis[i]);
            CHECK(metropolis[i].error < 0.02 * (joined[i].mean + mean)); // else the test would see nothing
        }
    }
}

// These tests check Russian roulette by expected contribution: its survival estimate from a pilot render, and its
// lack of bias.
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_gains.h"
#include "raytrace/pass.h"
#include "tests/raytrace/integrating_sphere.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;
using namespace duet::raytrace;

namespace {

float worth_of(const Scene& scene, int side, const Settings& settings) {
    const Prepared prepared = prepare(scene, settings);
    return RenderPlan(prepared.data(), View{scene.camera, side, side}, settings).worth;
}

// Calls trace(ray, hit, sampler) for independent samples of one pixel.
template <typename Trace> void for_samples(const RenderPlan& plan, std::uint32_t count, const Trace& trace) {
    const CameraModel camera(View{plan.scene.camera, 1, 1});
    Sampler sampler(SamplerKind::kIndependent, 3, static_cast<int>(count));
    for (std::uint32_t i = 0; i < count; ++i) {
        sampler.start(0, 0, i);
        const Ray ray = camera_ray(plan, camera, 0, 0, sampler);
        trace(ray, plan.prepared.accelerator.closest(ray), sampler);
    }
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the worth of throughput is learned from scene, view and plan alone") {
        const Scene scene = integrating_sphere();
        const float worth = worth_of(scene, 64, {});
        CHECK(worth > 2 * kPlainWorth); // fewer paths are ended where only roulette causes noise
        Settings other;
        other.seed = 99;
        other.threads = 1;
        other.samples_per_pixel = 7;
        other.first_sample = 64;
        other.sampler = SamplerKind::kIndependent;
        CHECK(worth_of(scene, 64, other) == worth);
        other.skips.shadow_rays = other.skips.last_bounce = other.skips.light_samples = false;
        CHECK(worth_of(scene, 64, other) == worth);
        CHECK(worth_of(scene, 8, {}) == kPlainWorth); // too few pixels for an estimate
        Settings naive;
        naive.integrator = Integrator::kNaive;
        CHECK(worth_of(scene, 64, naive) == kPlainWorth);
    }

    TEST_CASE("the statistics say what roulette ended") {
        const Scene scene = integrating_sphere();
        Settings settings;
        settings.samples_per_pixel = 4;
        const auto ended = [&] {
            Control control;
            const Rendering r = render(prepare(scene, settings), View{scene.camera, 16, 16}, settings, control);
            for (const Skipped& s : r.statistics.skipped)
                if (s.what == "paths ended by roulette") return s.count;
            return std::int64_t{-1};
        };
        CHECK(ended() == 4 * 16 * 16); // nothing else ends paths
        settings.russian_roulette = false;
        CHECK(ended() == -1);
    }
}

TEST_SUITE("statistical") {

    // Each bound is five standard errors, which is exceeded by chance once in 1.7 million times. A bias of 1 % is at
    // least five standard errors.
    TEST_CASE("whatever worth is learned, the mean is the integrating sphere's") {
        const Scene scene = integrating_sphere();
        Settings settings;
        const Prepared prepared = prepare(scene, settings);
        RenderPlan plan(prepared.data(), View{scene.camera, 64, 64}, settings);
        for (const float worth : {1.0f, kPlainWorth, plan.worth}) {
            CAPTURE(worth);
            plan.worth = worth;
            double sum = 0, squares = 0;
            constexpr std::uint32_t kCount = 200000;
            RayCounts counts;
            for_samples(plan, kCount, [&](const Ray& ray, const Hit& hit, Sampler& sampler) {
                const auto light = static_cast<double>(path_radiance(plan, ray, hit, sampler, counts).g);
                sum += light;
                squares += light * light;
            });
            const double mean = sum / kCount, error = std::sqrt((squares / kCount - mean * mean) / kCount);
            CHECK(std::abs(mean - kIntegratingSphere) < 5 * error);
            CHECK(error < kIntegratingSphere / 500);
        }
    }

    // Each step's light is its throughput × the exact radiance, except for roulette. The ratio of the sums has a
    // standard deviation of about 0.4 %.
    TEST_CASE("steps of a path know what it gathers, and its rays") {
        const Scene scene = integrating_sphere();
        Settings settings;
        const Prepared prepared = prepare(scene, settings);
        RenderPlan plan(prepared.data(), View{scene.camera, 8, 8}, settings);
        plan.worth = 4;
        double light = 0, throughput = 0, others = 0;
        for_samples(plan, 20000, [&](const Ray& ray, const Hit& hit, Sampler& sampler) {
            PathGains path;
            follow_path(plan, ray, hit, sampler, path);
            for (const PathStep& step : path.steps()) {
                light += static_cast<double>(step.weight * step.light);
                throughput += static_cast<double>(step.weight * step.throughput);
                others += step.next_rays != 2; // one continuation ray and one shadow ray
            }
            others += path.camera_rays() != 2 || path.steps().empty() || !path.steps().front().first;
        });
        CHECK(others == 0);
        CHECK(light / throughput == doctest::Approx(kIntegratingSphere).epsilon(0.03));
    }
}

// These tests check Russian roulette by expected contribution: its survival estimate from a pilot render, and its
// lack of bias.
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_contributions.h"
#include "raytrace/render_pass.h"
#include "tests/raytrace/integrating_sphere.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;
using namespace duet::raytrace;

namespace {

float survival_factor_of(const Scene& scene, int side, const PathTracerSettings& settings) {
    const PathTracerScene prepared = prepare(scene, settings);
    return RenderPlan(prepared.data(), View{scene.camera, side, side}, settings).survival_factor;
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

    TEST_CASE("the roulette survival factor is learned from scene, view and plan alone") {
        const Scene scene = integrating_sphere();
        const float survival_factor = survival_factor_of(scene, 64, {});
        CHECK(survival_factor > 2 * kDefaultSurvivalFactor); // fewer paths are ended where only roulette causes noise
        PathTracerSettings other;
        other.seed = 99;
        other.threads = 1;
        other.samples_per_pixel = 7;
        other.first_sample = 64;
        other.sampler = SamplerKind::kIndependent;
        CHECK(survival_factor_of(scene, 64, other) == survival_factor);
        other.skips.shadow_rays = other.skips.last_bounce = other.skips.light_samples = false;
        CHECK(survival_factor_of(scene, 64, other) == survival_factor);
        CHECK(survival_factor_of(scene, 8, {}) == kDefaultSurvivalFactor); // too few pixels for an estimate
        PathTracerSettings naive;
        naive.integrator = Integrator::kNaive;
        CHECK(survival_factor_of(scene, 64, naive) == kDefaultSurvivalFactor);
    }

    TEST_CASE("the statistics say what roulette ended") {
        const Scene scene = integrating_sphere();
        PathTracerSettings settings;
        settings.samples_per_pixel = 4;
        const auto ended = [&] {
            Control control;
            const Rendering r = render(prepare(scene, settings), View{scene.camera, 16, 16}, settings, control);
            for (const SkippedWork& s : r.statistics.skipped)
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
    TEST_CASE("whatever survival factor is estimated, the mean is the integrating sphere's") {
        const Scene scene = integrating_sphere();
        PathTracerSettings settings;
        const PathTracerScene prepared = prepare(scene, settings);
        RenderPlan plan(prepared.data(), View{scene.camera, 64, 64}, settings);
        for (const float survival_factor : {1.0f, kDefaultSurvivalFactor, plan.survival_factor}) {
            CAPTURE(survival_factor);
            plan.survival_factor = survival_factor;
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
        PathTracerSettings settings;
        const PathTracerScene prepared = prepare(scene, settings);
        RenderPlan plan(prepared.data(), View{scene.camera, 8, 8}, settings);
        plan.survival_factor = 4;
        double light = 0, throughput = 0, others = 0;
        for_samples(plan, 20000, [&](const Ray& ray, const Hit& hit, Sampler& sampler) {
            PathContributions path;
            record_path_contributions(plan, ray, hit, sampler, path);
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

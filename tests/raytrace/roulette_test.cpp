// These tests check Russian roulette: its lack of bias, and what the statistics say of it.
#include "raytrace/integrator/integrator.h"
#include "raytrace/render.h"
#include "raytrace/render_pass.h"
#include "tests/raytrace/integrating_sphere.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;
using namespace duet::raytrace;

namespace {

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

    TEST_CASE("the statistics say what roulette ended") {
        const Scene scene = integrating_sphere();
        PathTracerSettings settings;
        settings.samples_per_pixel = 4;
        const auto ended = [&] {
            Control control;
            const Rendering r = render(prepare(scene, settings), View{scene.camera, 16, 16}, settings, control);
            for (const SkippedWork& s : r.statistics.skipped)
                if (s.what == "paths ended by Russian roulette") return s.count;
            return std::int64_t{-1};
        };
        CHECK(ended() == 4 * 16 * 16); // nothing else ends paths
        settings.russian_roulette = false;
        CHECK(ended() == -1);
    }
}

TEST_SUITE("statistical") {

    // The bound is five standard errors, which is exceeded by chance once in 1.7 million times. A bias of 1 % is at
    // least five standard errors.
    TEST_CASE("with roulette, the mean is the integrating sphere's") {
        const Scene scene = integrating_sphere();
        PathTracerSettings settings;
        const PathTracerScene prepared = prepare(scene, settings);
        const RenderPlan plan(prepared.data(), View{scene.camera, 64, 64}, settings);
        double sum = 0, squares = 0;
        constexpr std::uint32_t kCount = 200000;
        RayCounts counts;
        for_samples(plan, kCount, [&](const Ray& ray, const Hit& hit, Sampler& sampler) {
            const auto light = static_cast<double>(path_radiance(plan, ray, hit, sampler, counts).g);
            sum += light;
            squares += light * light;
        });
        const double mean = sum / kCount, error = std::sqrt((squares / kCount - mean * mean) / kCount);
        CHECK(counts.ended > kCount / 2);
        CHECK(std::abs(mean - kIntegratingSphere) < 5 * error);
        CHECK(error < kIntegratingSphere / 500);
    }
}

// These tests check that estimators of the same light agree: with and without light sampling, with and without
// Russian roulette.
#include "raytrace/integrator/light_sampling.h"
#include "raytrace/integrator/mis.h"
#include "raytrace/render.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

// Returns a corner with a large light, a small bright light that moves (light sampling cannot find it), a dim sky,
// and a material of every kind.
Scene corner(bool moving_area_light) {
    SceneBuilder builder;
    const std::uint32_t white = builder.material(Diffuse{{Rgb(0.8f)}});
    const std::uint32_t brushed = builder.material(Metal{{Rgb(0.9f, 0.8f, 0.7f)}, 0.4f});
    const std::uint32_t mirror = builder.material(Metal{{Rgb(0.9f)}, 0});
    const std::uint32_t glass = builder.material(Dielectric{1.5f, {Rgb(0.95f)}});
    const std::uint32_t area_light = builder.material(Emissive{Rgb(3.0f)});
    const std::uint32_t glow = builder.material(Emissive{Rgb(8.0f), true, {Rgb(0.3f)}});
    builder.add(quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}), white);
    builder.add(quad({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}), brushed);
    builder.add(quad({-2, 0, 2}, {0, 0, -4}, {0, 3, 0}), white);
    builder.add(quad({-1, 2.5f, -1.5f}, {2, 0, 0}, {0, 0, 2}), area_light);
    builder.add(Sphere{{-1, 0.6f, -0.8f}, 0.6f}, mirror);
    builder.add(Sphere{{0.8f, 0.5f, 0.2f}, 0.5f}, glass);
    builder.add(icosphere(2, 0.5f, {-0.2f, 0.5f, 0.6f}, true), brushed);
    if (moving_area_light) {
        const std::uint32_t ball = builder.shape(Sphere{{0, 0, 0}, 0.3f});
        builder.place_moving(ball, glow, translation(Vec3(1.2f, 1.5f, -1)), translation(Vec3(1.2f, 1.0f, -0.5f)));
    } else {
        builder.add(Sphere{{1.2f, 1.5f, -1}, 0.3f}, glow);
    }
    builder.scene.environment = SkyEnvironment{Rgb(0.1f), Rgb(0.2f, 0.3f, 0.5f)};
    builder.scene.camera.eye = {0.5, 1.2, 5};
    builder.scene.camera.look_at = {0, 0.9, 0};
    builder.scene.camera.fov_degrees = 40;
    return builder.finish();
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("weights of the two ways to one sample add up to 1, at all magnitudes") {
        for (const float a : {1e-20f, 1e-3f, 1.0f, 3.0f, 1e20f})
            for (const float b : {1e-20f, 1e-3f, 1.0f, 3.0f, 1e20f})
                CHECK(mis_weight(a, b) + mis_weight(b, a) == doctest::Approx(1));
        CHECK(mis_weight(1.0f, 0.0f) == 1);
        CHECK(mis_weight(1.0f, kInfinity) == 0);
    }

    TEST_CASE("the density of a light sample is what its hit is weighed with") {
        const Scene scene = corner(false);
        PathTracerSettings settings;
        const PathTracerScene prepared = prepare(scene, settings);
        const LightSampler& lights = prepared.data().lights;
        Sampler sampler(SamplerKind::kIndependent, 1, 1);
        int compared = 0;
        for (std::uint32_t i = 0; i < 20000; ++i) {
            sampler.start(0, 0, i);
            const Vec3 p(-0.9f, 0, 1.4f);
            const LightReceiver receiver{p, i % 2 == 0 ? Vec3(0, 1, 0) : Vec3()};
            const float choice = sampler.get_2d().x;
            const auto light_sample = sample_li(scene, lights, receiver, choice, sampler.get_2d());
            if (!light_sample) continue;
            if (light_sample->light < 0) {
                CHECK(pdf_li(scene.environment, lights, receiver, light_sample->wi) ==
                      doctest::Approx(light_sample->pdf).epsilon(1e-3));
                continue;
            }
            const Ray ray{p, light_sample->wi};
            const Hit hit = trace(prepared, ray);
            if (!hit.valid() || hit.t < light_sample->distance * 0.999f) continue;
            CHECK(pdf_li(scene, lights, receiver, surface_point(scene, ray, hit)) ==
                  doctest::Approx(light_sample->pdf).epsilon(2e-2)); // a sphere's density changes quickly near its rim
            ++compared;
        }
        CHECK(compared > 500);
    }

    TEST_CASE("rays are counted, and sent as far as the depth allows") {
        const Scene scene = corner(false);
        PathTracerSettings settings;
        settings.samples_per_pixel = 1;
        settings.max_depth = 0;
        RenderStatistics statistics = render_scene(scene, 16, settings).statistics;
        CHECK(statistics.camera_rays == 256);
        CHECK(statistics.indirect_rays == 0);
        CHECK(statistics.shadow_rays == 0);
        settings.max_depth = 1;
        statistics = render_scene(scene, 16, settings).statistics;
        CHECK(statistics.indirect_rays > 100);
        CHECK(statistics.indirect_rays <= 256);
        CHECK(statistics.shadow_rays > 10);
        CHECK(statistics.shadow_rays <= 256);
    }
}

TEST_SUITE("statistical") {

    // The bound is six standard errors of the difference over ten seeds each, which is exceeded by chance once in
    // 90,000 times.
    TEST_CASE("path tracing with light samples gives what it gives without, moving lights included") {
        for (const bool moving : {false, true}) {
            CAPTURE(moving);
            const Scene scene = corner(moving);
            PathTracerSettings settings;
            settings.samples_per_pixel = 32;
            settings.max_depth = 8;
            CHECK(check_against_naive(scene, 24, settings, 128).mean > 0.1);
        }
    }

    TEST_CASE("Russian roulette changes the cost, not the mean") {
        const Scene scene = corner(false);
        PathTracerSettings settings;
        settings.samples_per_pixel = 64;
        const Estimate with = estimate(scene, 24, settings);
        const auto rays_with = render_scene(scene, 24, settings).statistics.indirect_rays;
        settings.russian_roulette = false;
        const Estimate without = estimate(scene, 24, settings);
        const auto rays_without = render_scene(scene, 24, settings).statistics.indirect_rays;
        check_equal_means(with, without);
        CHECK(with.error < 0.005 * with.mean);
        CHECK(rays_with < rays_without);
    }

    TEST_CASE("all samplers estimate the same") {
        const Scene scene = corner(false);
        PathTracerSettings settings;
        settings.samples_per_pixel = 32;
        settings.max_depth = 6;
        const Estimate sobol = estimate(scene, 24, settings);
        for (const SamplerKind kind : {SamplerKind::kStratified, SamplerKind::kIndependent}) {
            settings.sampler = kind;
            check_equal_means(sobol, estimate(scene, 24, settings));
        }
    }
}

// These tests check light sampling that covers only a fraction of the light (of many lights, of an environment's
// peaks), and pixel filters. The estimates must equal those of BSDF sampling.
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

// Returns a floor and a wall below forty lights of all shapes, sizes and powers, on both sides of the surfaces that
// they illuminate.
Scene many_area_lights() {
    SceneBuilder builder;
    const std::uint32_t white = builder.material(Diffuse{{Rgb(0.7f)}});
    const std::uint32_t brushed = builder.material(Metal{{Rgb(0.9f, 0.8f, 0.7f)}, 0.5f});
    builder.add(quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), white);
    builder.add(quad({-3, 0, -3}, {6, 0, 0}, {0, 3, 0}), brushed);
    Sampler s(SamplerKind::kIndependent, 3, 1);
    for (std::uint32_t i = 0; i < 40; ++i) {
        s.start(0, 0, i);
        const auto u = s.get_block(), v = s.get_block();
        const Vec3 p(4 * u[0] - 2, 0.4f + 2 * u[1], 4 * u[2] - 2);
        const std::uint32_t area_light = builder.material(Emissive{Rgb(0.5f + 8 * u[3] * u[3]), u[4] < 0.4f});
        const Vec3 a = Vec3(u[5] - 0.5f, u[6] - 0.5f, u[7] - 0.5f), b = Vec3(v[0] - 0.5f, v[1] - 0.5f, v[2] - 0.5f);
        if (i % 3 == 0)
            builder.add(Sphere{p, 0.05f + 0.2f * v[3]}, area_light);
        else
            builder.add(quad(p, a, b), area_light);
    }
    builder.scene.camera.eye = {0.5f, 2, 6};
    builder.scene.camera.look_at = {0, 0.8f, 0};
    builder.scene.camera.fov_degrees = 40;
    return builder.finish();
}

// Returns a sphere on a floor under a sky with a sun of a few pixels and little else above the mean.
Scene under_a_image() {
    SceneBuilder builder;
    builder.add(quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), builder.material(Diffuse{{Rgb(0.6f)}}));
    builder.add(Sphere{{0, 0.7f, 0}, 0.7f}, builder.material(Metal{{Rgb(0.9f)}, 0.6f}));
    ImageRgb sky(32, 16, Rgb(0.2f, 0.3f, 0.5f));
    for (int x = 5; x < 9; ++x)
        for (int y = 3; y < 6; ++y) sky(x, y) = Rgb(20.0f);
    builder.scene.environment = make_image_environment(sky, 1, 0.3f);
    builder.scene.camera.eye = {0.5f, 2, 5};
    builder.scene.camera.look_at = {0, 0.5f, 0};
    builder.scene.camera.fov_degrees = 40;
    return builder.finish();
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("an even sky has no shadow rays, an image with a sun has") {
        PathTracerSettings settings;
        settings.samples_per_pixel = 4;
        const Rendering image = render_scene(under_a_image(), 16, settings);
        CHECK(image.statistics.shadow_rays > 100);
        SceneBuilder builder;
        builder.add(Sphere{{0, 0, 0}, 1}, builder.material(Diffuse{{Rgb(0.6f)}}));
        builder.scene.environment = SkyEnvironment{};
        const Scene plain = builder.finish();
        const Rendering even = render_scene(plain, 16, settings);
        CHECK(even.statistics.shadow_rays == 0);
        bool messages = false;
        for (const SkippedWork& s : even.statistics.skipped) messages |= s.what == "light samples";
        CHECK(messages);
    }

    TEST_CASE("a wider filter sees what lies beside its pixel") {
        SceneBuilder builder;
        const std::uint32_t area_light = builder.material(Emissive{Rgb(1.0f), true});
        builder.add(quad({0, -5, 0}, {5, 0, 0}, {0, 10, 0}), area_light); // the right half
        builder.scene.camera.eye = {0, 0, 2};
        builder.scene.camera.look_at = {0, 0, 0};
        const Scene scene = builder.finish();
        PathTracerSettings settings;
        settings.samples_per_pixel = 256;
        settings.max_depth = 0;
        const ImageRgb box = render_scene(scene, 8, settings).radiance;
        settings.filter = FilterKind::kBlackmanHarris;
        const ImageRgb bell = render_scene(scene, 8, settings).radiance;
        for (int y = 0; y < 8; ++y) {
            CHECK(box(3, y).g == 0);
            CHECK(box(4, y).g == 1);
            // A fraction of 0.1186 of the filter is beyond 1/2 pixel in the window of 3 pixels.
            CHECK(bell(3, y).g == doctest::Approx(0.1186).epsilon(0.02));
            CHECK(bell(4, y).g == doctest::Approx(1 - 0.1186).epsilon(0.01));
            CHECK(bell(2, y).g == 0);
            CHECK(bell(5, y).g == 1);
        }
    }
}

TEST_SUITE("statistical") {
    // The bound is six standard errors of the difference over ten seeds each, which is exceeded by chance once in
    // 90,000 times.
    TEST_CASE("light samples of many lights, and of an environment's peaks, give what chance finds") {
        const std::pair<Scene, int> scenes[] = {{many_area_lights(), 128}, {under_a_image(), 256}};
        for (const auto& [scene, naive_samples] : scenes) {
            PathTracerSettings settings;
            settings.samples_per_pixel = 32;
            settings.max_depth = 4;
            check_against_naive(scene, 24, settings, naive_samples);
        }
    }

    TEST_CASE("blue noise estimates what other samplers do") {
        const Scene scene = many_area_lights();
        PathTracerSettings settings;
        settings.samples_per_pixel = 16;
        settings.max_depth = 4;
        const Estimate sobol = estimate(scene, 24, settings);
        settings.sampler = SamplerKind::kBlueNoise;
        check_equal_means(sobol, estimate(scene, 24, settings));
    }
}

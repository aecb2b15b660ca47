#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

PathTracerSettings with(Integrator integrator, int samples = 1, int depth = 64) {
    PathTracerSettings settings;
    settings.integrator = integrator;
    settings.samples_per_pixel = samples;
    settings.max_depth = depth;
    return settings;
}

/// Returns a white floor seen from above, and the material index of the floor.
SceneBuilder floor() {
    SceneBuilder builder;
    builder.add(quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), builder.material(Diffuse{{Rgb(0.8f)}}));
    builder.scene.camera.eye = {0, 4, 0.01};
    builder.scene.camera.look_at = {0, 0, 0};
    builder.scene.camera.fov_degrees = 25;
    return builder;
}

double largest_difference(const ImageRgb& a, const ImageRgb& b) {
    double largest = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            largest = std::max(largest, std::abs(static_cast<double>(a(x, y).g - b(x, y).g)));
    return largest;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("Whitted: a point light gives the same direct light as in the path tracer") {
        SceneBuilder builder = floor();
        builder.add(Sphere{{0.3f, 0.3f, 0}, 0.2f}, builder.material(Diffuse{{Rgb(0.5f)}}));
        builder.scene.lights = {PointLight{{-0.5f, 1.5f, 0}, Rgb(3.0f)}};
        const Scene scene = builder.finish();
        const ImageRgb expected = render_scene(scene, 24, with(Integrator::kPath, 1, 1)).radiance;
        CHECK(mean_of(expected).g > 0.1);
        CHECK(largest_difference(expected, render_scene(scene, 24, with(Integrator::kWhitted)).radiance) < 1e-6);
        // Surfaces do not light each other, however long paths may be.
        CHECK(mean_of(render_scene(scene, 24, with(Integrator::kPath, 64)).radiance).g > 1.01 * mean_of(expected).g);
        // Without scattering there is only emission.
        CHECK(mean_of(render_scene(scene, 24, with(Integrator::kWhitted, 1, 0)).radiance).g == 0);
    }

    TEST_CASE("Whitted: every light counts, and one of area shines from its center") {
        SceneBuilder builder = floor();
        const std::uint32_t light = builder.material(Emissive{Rgb(4.0f)});
        builder.add(quad({-0.5f, 2, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f}), light); // faces down
        builder.add(quad({0.25f, 2, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f}), light);
        builder.scene.camera.eye = {0, 1.5, 0.01};
        builder.scene.camera.fov_degrees = 50;
        const Scene scene = builder.finish();
        const ImageRgb image = render_scene(scene, 17, with(Integrator::kWhitted)).radiance;
        double expected = 0; // at the middle: L cos² A / d² of each light, times albedo / π
        for (const double x : {-0.25, 0.5}) {
            const double squared = x * x + 4;
            expected += 4 * (4 / squared) * 0.25 / squared * 0.8 / kPiDouble;
        }
        CHECK(static_cast<double>(image(8, 8).g) == doctest::Approx(expected).epsilon(2e-3));
    }

    TEST_CASE("Whitted: shadows of area lights are hard") {
        SceneBuilder builder = floor();
        builder.add(quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), builder.material(Emissive{Rgb(4.0f)}));
        builder.add(quad({0, 0.5f, 1}, {1, 0, 0}, {0, 0, -2}), builder.material(Diffuse{{Rgb(0.0f)}}));
        builder.scene.camera.eye = {-0.4, 0.3, 0.01};
        builder.scene.camera.look_at = {0, 0, 0};
        const Scene scene = builder.finish();
        // The shadow's edge lies at x = 0, below the edge of what casts it. No pixel is between light and dark.
        const ImageRgb hard = render_scene(scene, 32, with(Integrator::kWhitted)).radiance;
        const ImageRgb soft = render_scene(scene, 32, with(Integrator::kDirect, 64)).radiance;
        const auto between = [](const ImageRgb& image) {
            float most = 0;
            for (const Rgb& pixel : image) most = std::max(most, pixel.g);
            return std::ranges::count_if(image, [&](const Rgb& p) { return p.g > 0.1f * most && p.g < 0.5f * most; });
        };
        CHECK(between(hard) == 0);
        CHECK(between(soft) > 20);
    }

    TEST_CASE("Whitted: mirrors and glass show what is behind them") {
        SceneBuilder builder = floor();
        builder.scene.lights = {PointLight{{-0.5f, 1.5f, 0}, Rgb(3.0f)}};
        const ImageRgb seen = render_scene(builder.finish(), 16, with(Integrator::kWhitted)).radiance;

        // A pane of index 1 lies below the light and above the floor, so it darkens the floor but not the view of it.
        SceneBuilder through = floor();
        through.scene.lights = {PointLight{{-0.5f, 1.5f, 0}, Rgb(3.0f)}};
        through.add(quad({-2, 3, 2}, {4, 0, 0}, {0, 0, -4}), through.material(Dielectric{1.0f, {Rgb(1.0f)}}));
        CHECK(largest_difference(seen, render_scene(through.finish(), 16, with(Integrator::kWhitted)).radiance) < 1e-5);

        // The camera looks at a mirror from below, which shows the floor as from 4 m above it.
        SceneBuilder mirrored = floor();
        mirrored.scene.lights = {PointLight{{-0.5f, 1.5f, 0}, Rgb(3.0f)}};
        mirrored.add(quad({-2, 3, -2}, {4, 0, 0}, {0, 0, 4}), mirrored.material(Metal{{Rgb(1.0f)}, 0}));
        mirrored.scene.camera.eye = {0, 2, 0.01};
        mirrored.scene.camera.look_at = {0, 3, 0};
        const double mirror = mean_of(render_scene(mirrored.finish(), 16, with(Integrator::kWhitted, 4)).radiance).g;
        CHECK(mirror == doctest::Approx(mean_of(seen).g).epsilon(0.02));
    }
}

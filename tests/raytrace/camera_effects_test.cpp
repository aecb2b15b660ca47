// These tests compare motion blur and depth of field with geometry.
#include "raytrace/render.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

PathTracerSettings emission_only(int samples) {
    PathTracerSettings settings;
    settings.max_depth = 0;
    settings.samples_per_pixel = samples;
    return settings;
}

} // namespace

TEST_SUITE("unit") {

    // A light of width 1 moves 4 meters during the motion, so a point of its path is covered a quarter of the time.
    // Sobol's 1D points are stratified, so 256 samples give the fraction to better than 1/64.
    TEST_CASE("a moving light is seen for the time that it is there, within the shutter") {
        for (const double close : {1.0, 0.25}) {
            SceneBuilder builder;
            const std::uint32_t area_light = builder.material(Emissive{Rgb(1.0f)});
            const std::uint32_t shape = builder.shape(quad({-0.5f, -1, 0}, {1, 0, 0}, {0, 2, 0}));
            builder.place_moving(shape, area_light, translation(Vec3(-2, 0, 0)), translation(Vec3(2, 0, 0)));
            Camera& camera = builder.scene.camera;
            camera.eye = {-1.2, 0, 5};
            camera.look_at = {-1.2, 0, 0};
            camera.fov_degrees = 0.01;
            camera.shutter_close = close;
            const Scene scene = builder.finish();
            // At time t the light covers [−2.5 + 4t, −1.5 + 4t], which includes x = −1.2 from t = 0.075 to 0.325.
            const double expected = close == 1.0 ? 0.25 : (0.25 - 0.075) / 0.25;
            const double seen = mean_of(render_scene(scene, 2, emission_only(256)).radiance).g;
            CHECK(seen == doctest::Approx(expected).epsilon(0.07));
        }
    }

    // The lens has radius 1 and focuses at 4. A light's edge is at distance 2, and the light continues beyond it. The
    // rays of one pixel cross the edge's plane in a disk of radius ½. The edge cuts that disk at 0.2 from its center,
    // so the covered area is a circular segment.
    TEST_CASE("an edge out of focus is blurred by the lens's disk") {
        SceneBuilder builder;
        const std::uint32_t area_light = builder.material(Emissive{Rgb(1.0f)});
        builder.add(quad({0.2f, -10, -2}, {10, 0, 0}, {0, 20, 0}), area_light);
        Camera& camera = builder.scene.camera;
        camera.eye = {0, 0, 0};
        camera.look_at = {0, 0, -1};
        camera.fov_degrees = 0.01;
        camera.aperture_radius = 1;
        camera.focus_distance = 4;
        const Scene scene = builder.finish();
        const double d = 0.2 / 0.5;
        const double expected = (std::acos(d) - d * std::sqrt(1 - d * d)) / kPiDouble;
        const double seen = mean_of(render_scene(scene, 4, emission_only(256)).radiance).g;
        CHECK(seen == doctest::Approx(expected).epsilon(0.02));

        // The edge is sharp in focus: a pixel off the axis by more than its extent receives no light.
        camera.focus_distance = 2;
        Control control;
        View view{scene.camera, 4, 4};
        view.camera.focus_distance = 2;
        const PathTracerSettings settings = emission_only(64);
        CHECK(mean_of(render(prepare(scene, settings), view, settings, control).radiance).g == 0);
    }

    TEST_CASE("where nothing moves, times of one's own change no bit") {
        SceneBuilder builder;
        builder.add(Sphere{{0, 0, 0}, 1}, builder.material(Diffuse{}));
        builder.scene.environment = SkyEnvironment{};
        Scene scene = builder.finish();
        PathTracerSettings settings;
        settings.samples_per_pixel = 4;
        const Rendering without = render_scene(scene, 16, settings);
        scene.needs.motion = true; // deliberately wrong, so that times are sampled
        const Rendering with = render_scene(scene, 16, settings);
        CHECK(without.radiance.pixels() == with.radiance.pixels());
        CHECK(without.statistics.skipped.size() > with.statistics.skipped.size());
    }
}

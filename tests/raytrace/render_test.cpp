// These tests check the render loop: the same bits for any thread count, limits, interruption, AOVs and statistics.
#include "common/system/error.h"
#include "raytrace/render.h"
#include "raytrace/render_pass.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace duet;
using namespace duet::raytrace;

namespace {

Scene small_scene() {
    SceneBuilder builder;
    const std::uint32_t grey = builder.material(Diffuse{{Rgb(0.5f, 0.6f, 0.7f)}});
    const std::uint32_t metal = builder.material(Metal{{Rgb(0.9f)}, 0.3f});
    const std::uint32_t area_light = builder.material(Emissive{Rgb(4.0f)});
    builder.add(quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), grey);
    builder.add(Sphere{{-0.7f, 0, 0}, 1}, metal);
    builder.add(icosphere(2, 0.7f, {1, -0.3f, 0.3f}, true), grey);
    builder.add(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), area_light);
    builder.scene.environment = SkyEnvironment{};
    builder.scene.camera.aperture_radius = 0.02;
    return builder.finish();
}

Rendering rendered(const Scene& scene, const PathTracerSettings& settings, Control control = {}) {
    return render(prepare(scene, settings), View{scene.camera, 40, 30}, settings, control);
}

AovSet all_aovs() {
    AovSet set;
    set.depth = set.normal = set.albedo = set.hit = set.variance = set.samples = true;
    return set;
}

template <typename T> bool has(const std::vector<SkippedWork>& list, const T& what) {
    return std::any_of(list.begin(), list.end(), [&](const SkippedWork& s) { return s.what == what; });
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the same bits for 1, 2 and 7 threads") {
        const Scene scene = small_scene();
        PathTracerSettings settings;
        settings.samples_per_pixel = 20;
        settings.aovs = all_aovs();
        settings.threads = 1;
        const Rendering one = rendered(scene, settings);
        for (const int threads : {2, 7}) {
            settings.threads = threads;
            const Rendering other = rendered(scene, settings);
            CHECK(one.radiance.pixels() == other.radiance.pixels());
            CHECK(one.depth.pixels() == other.depth.pixels());
            CHECK(one.normal.pixels() == other.normal.pixels());
            CHECK(one.albedo.pixels() == other.albedo.pixels());
            CHECK(one.hit.pixels() == other.hit.pixels());
            CHECK(one.variance.pixels() == other.variance.pixels());
            CHECK(one.statistics.shadow_rays == other.statistics.shadow_rays);
            CHECK(one.statistics.indirect_rays == other.statistics.indirect_rays);
        }
    }

    TEST_CASE("the same bits however the samples are divided into passes; another seed gives others") {
        const Scene scene = small_scene();
        PathTracerSettings settings;
        settings.samples_per_pixel = 12;
        const Rendering plain = rendered(scene, settings);
        CHECK(plain.statistics.passes == 1);
        settings.time_limit = 1e6; // never reached
        const Rendering passes = rendered(scene, settings);
        CHECK(passes.statistics.passes == 4); // 2, 2, 4 and the remainder
        CHECK(plain.radiance.pixels() == passes.radiance.pixels());
        settings.seed = 1;
        CHECK(plain.radiance.pixels() != rendered(scene, settings).radiance.pixels());
    }

    TEST_CASE("a limit of time or error ends the render between passes") {
        const Scene scene = small_scene();
        PathTracerSettings settings;
        settings.samples_per_pixel = 1 << 30;
        settings.time_limit = 0.05;
        const Rendering timed = rendered(scene, settings);
        CHECK(timed.statistics.samples_per_pixel >= 2);
        CHECK(timed.statistics.samples_per_pixel < 1 << 20);
        CHECK(!timed.statistics.interrupted);
        settings.time_limit = 0;
        settings.error_limit = 0.02;
        const Rendering good = rendered(scene, settings);
        CHECK(good.statistics.estimated_relmse < 0.02);
        CHECK(good.statistics.samples_per_pixel < 4096);
        CHECK(good.statistics.camera_rays == 40 * 30 * good.statistics.samples_per_pixel);
    }

    TEST_CASE("stopped in the middle it returns what is done") {
        const Scene scene = small_scene();
        PathTracerSettings settings;
        settings.samples_per_pixel = 160;
        settings.threads = 1;
        settings.aovs.samples = true;
        settings.aovs.variance = true;
        std::atomic<bool> stop = false;
        double last = 0;
        Control control;
        control.stop = &stop;
        control.progress = [&](double fraction) {
            CHECK(fraction >= last);
            last = fraction;
            if (fraction > 0.25) stop = true;
        };
        const Rendering rendering = rendered(scene, settings, control);
        CHECK(rendering.statistics.interrupted);
        CHECK(rendering.statistics.passes == 2);
        CHECK(rendering.statistics.samples_per_pixel == 32);
        const auto [fewest, most] =
            std::minmax_element(rendering.samples.pixels().begin(), rendering.samples.pixels().end());
        CHECK(*fewest == 32);
        CHECK(*most == 48); // the finished tiles of the third pass are retained
        const Rgbd mean = mean_of(rendering.radiance);
        settings.samples_per_pixel = 32;
        CHECK(mean.g == doctest::Approx(mean_of(rendered(scene, settings).radiance).g).epsilon(0.02));

        stop = true; // stopped from the start: a black image and no error
        control.progress = nullptr;
        const Rendering nothing = rendered(scene, settings, control);
        CHECK(nothing.statistics.interrupted);
        CHECK(nothing.statistics.samples_per_pixel == 0);
        CHECK(mean_of(nothing.radiance).g == 0);
    }

    TEST_CASE("progress never decreases and ends at 1") {
        const Scene scene = small_scene();
        for (const double error_limit : {0.0, 0.01}) {
            PathTracerSettings settings;
            settings.samples_per_pixel = 24;
            settings.error_limit = error_limit;
            double last = 0;
            bool ordered = true;
            Control control;
            control.progress = [&](double fraction) {
                ordered = ordered && fraction >= last && fraction <= 1;
                last = fraction;
            };
            const Rendering rendering = rendered(scene, settings, control);
            CHECK(ordered);
            if (rendering.statistics.samples_per_pixel == 24) CHECK(last == 1);
        }
    }

    TEST_CASE("auxiliary images show what the camera's rays hit") {
        SceneBuilder builder;
        builder.add(quad({-5, -5, -3}, {10, 0, 0}, {0, 10, 0}), builder.material(Diffuse{{Rgb(0.2f, 0.4f, 0.6f)}}));
        builder.add(quad({-5, -5, -4}, {0, 10, 0}, {10, 0, 0}), 0); // hidden
        builder.scene.camera.eye = {0, 0, 0};
        builder.scene.camera.look_at = {0, 0, -1};
        builder.scene.camera.fov_degrees = 60;
        const Scene scene = builder.finish();
        PathTracerSettings settings;
        settings.samples_per_pixel = 4;
        settings.sampler = SamplerKind::kCenter;
        settings.aovs = all_aovs();
        Control control;
        View view{scene.camera, 8, 8};
        const PathTracerScene prepared = prepare(scene, settings);
        Rendering rendering = render(prepared, view, settings, control);
        const CameraModel camera(view);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                CHECK(rendering.depth(x, y) == doctest::Approx(3)); // along −z, not along the ray
                CHECK(rendering.normal(x, y).z == doctest::Approx(1));
                CHECK(rendering.albedo(x, y).b == doctest::Approx(0.6));
                CHECK(rendering.samples(x, y) == 4);
                CHECK(rendering.hit(x, y) == trace(prepared, camera.ray({x + 0.5, y + 0.5})));
                CHECK(rendering.hit(x, y).object == 0);
            }
        view.camera.look_at = {0, 0, 1}; // nothing is visible in the opposite direction
        rendering = render(prepared, view, settings, control);
        CHECK(rendering.depth(3, 3) == kInfinity);
        CHECK(rendering.normal(3, 3) == Vec3());
        CHECK(is_black(rendering.albedo(3, 3)));
        CHECK(!rendering.hit(3, 3).valid());

        view.camera.eye = {0, 0, -10}; // from behind: the normal faces the camera
        rendering = render(prepared, view, settings, control);
        CHECK(rendering.normal(3, 3).z == doctest::Approx(-1));

        settings.aovs = {};
        rendering = render(prepared, view, settings, control);
        CHECK(rendering.depth.empty());
        CHECK(rendering.hit.empty());
        CHECK(rendering.variance.empty());
    }

    TEST_CASE("camera rays start at the near plane") {
        SceneBuilder builder;
        builder.add(quad({-5, -5, -1}, {10, 0, 0}, {0, 10, 0}), builder.material(Emissive{Rgb(1.0f)}));
        builder.add(quad({-5, -5, -2}, {10, 0, 0}, {0, 10, 0}), builder.material(Emissive{Rgb(2.0f)}));
        builder.scene.camera.eye = {0, 0, 0};
        builder.scene.camera.look_at = {0, 0, -1};
        builder.scene.camera.near = 1.5;
        const Scene scene = builder.finish();
        PathTracerSettings settings;
        settings.samples_per_pixel = 1;
        for (const Rgb& pixel : render_scene(scene, 8, settings).radiance) CHECK(pixel.g == 2);
    }

    TEST_CASE("colors of surfaces: normals and albedos") {
        SceneBuilder builder;
        builder.add(quad({-5, -5, -1}, {10, 0, 0}, {0, 10, 0}), builder.material(Diffuse{{Rgb(0.2f, 0.4f, 0.6f)}}));
        builder.scene.camera.eye = {0, 0, 1};
        const Scene scene = builder.finish();
        PathTracerSettings settings;
        settings.samples_per_pixel = 1;
        settings.integrator = integrator("normal");
        CHECK(render_scene(scene, 4, settings).radiance(1, 1).b == doctest::Approx(1));
        CHECK(render_scene(scene, 4, settings).radiance(1, 1).r == doctest::Approx(0.5));
        settings.integrator = integrator("albedo");
        const Rendering albedo = render_scene(scene, 4, settings);
        CHECK(albedo.radiance(1, 1) == Rgb(0.2f, 0.4f, 0.6f));
        CHECK(has(albedo.statistics.skipped, "bounces"));
    }

    TEST_CASE("what is skipped is named; a black environment and one left out give the same bits") {
        SceneBuilder builder;
        builder.add(Sphere{{0, 0, 0}, 1}, builder.material(Metal{{Rgb(0.9f)}, 0}));
        builder.add(Sphere{{0, 3, 0}, 1}, builder.material(Emissive{Rgb(1.0f)}));
        const Scene lit = builder.finish();
        PathTracerSettings settings;
        settings.samples_per_pixel = 4;
        const Rendering with_area_light = render_scene(lit, 16, settings);
        for (const auto* what : {"textures", "lens samples", "time samples", "environment", "instance transforms"})
            CHECK_MESSAGE(has(with_area_light.statistics.skipped, what), what);
        settings.environment = false;
        CHECK(with_area_light.radiance.pixels() == render_scene(lit, 16, settings).radiance.pixels());

        // Light samples cannot contribute at mirrors, so skipping them must not change the result.
        builder = {};
        builder.add(Sphere{{0, 0, 0}, 1}, builder.material(Metal{{Rgb(0.9f)}, 0}));
        builder.scene.environment = SkyEnvironment{};
        const Scene mirror = builder.finish();
        settings = {};
        settings.samples_per_pixel = 4;
        const Rendering path = render_scene(mirror, 16, settings);
        CHECK(has(path.statistics.skipped, "light samples"));
        settings.integrator = Integrator::kNaive;
        CHECK(path.radiance.pixels() == render_scene(mirror, 16, settings).radiance.pixels());
    }

    TEST_CASE("a BSDF made once a material gives the bits of one made at each hit") {
        const auto sphere_with = [](std::int32_t texture) {
            SceneBuilder builder;
            // Both colors of the checkerboard are white.
            builder.scene.textures.textures.push_back(CheckerTexture{Rgb(1.0f), Rgb(1.0f), 1, true});
            builder.add(Sphere{{0, 0, 0}, 1}, builder.material(Diffuse{{Rgb(0.3f, 0.5f, 0.7f), texture}}));
            builder.scene.environment = SkyEnvironment{};
            PathTracerSettings settings;
            settings.samples_per_pixel = 4;
            return render_scene(builder.finish(), 16, settings);
        };
        const Rendering plain = sphere_with(-1), textured = sphere_with(0);
        CHECK(plain.radiance.pixels() == textured.radiance.pixels());
        CHECK(has(plain.statistics.skipped, "textures"));
        CHECK(!has(textured.statistics.skipped, "textures"));
    }

    TEST_CASE("an empty scene is its background; names and settings that make no sense are refused") {
        SceneBuilder builder;
        builder.scene.environment = ConstantEnvironment{Rgb(0.25f)};
        const Scene nothing = builder.finish();
        PathTracerSettings settings;
        settings.samples_per_pixel = 2;
        for (const Rgb& pixel : render_scene(nothing, 4, settings).radiance) CHECK(pixel.g == 0.25f);

        CHECK(integrator("unshadowed") == Integrator::kUnshadowed);
        CHECK(integrator("lights") == Integrator::kLights);
        CHECK(integrator("environment") == Integrator::kEnvironment);
        CHECK(integrator("reflection") == Integrator::kReflection);
        CHECK_THROWS_AS(integrator("magic"), Error);
        CHECK_THROWS_AS(render_scene(nothing, 0, settings), Error);
        settings.samples_per_pixel = 0;
        CHECK_THROWS_AS(render_scene(nothing, 4, settings), Error);
        settings.samples_per_pixel = 1;
        settings.max_depth = -1;
        CHECK_THROWS_AS(render_scene(nothing, 4, settings), Error);
    }
}

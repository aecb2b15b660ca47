// These tests compare direct light with closed forms.
#include "tests/support/form_factor.h"
#include "raytrace/render.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

constexpr float kAlbedo = 0.6f;

// Returns a floor around the origin and a camera that looks straight down at a small square of it. All pixels have
// nearly the radiance of the origin.
SceneBuilder floor_scene(float scale = 1) {
    SceneBuilder builder;
    builder.add(quad(Vec3(-3, 0, 3) * scale, Vec3(6, 0, 0) * scale, Vec3(0, 0, -6) * scale),
                builder.material(Diffuse{{Rgb(kAlbedo)}}));
    Camera& camera = builder.scene.camera;
    camera.projection = Camera::Projection::kOrthographic;
    camera.eye = Vec3d(0, 0.5, 0) * static_cast<double>(scale);
    camera.look_at = {0, 0, 0};
    camera.up = {0, 0, -1};
    camera.height = 1e-3 * static_cast<double>(scale);
    return builder;
}

// Returns the floor's radiance from every light of the scene, without shadows.
double closed_form(const Scene& scene) {
    double irradiance = 0;
    for (const Light& light : scene.lights)
        if (const auto* surface = std::get_if<SurfaceLight>(&light))
            irradiance += static_cast<double>(surface_light_irradiance(*surface, {0, 0, 0}, {0, 1, 0}).g);
    return irradiance * static_cast<double>(kAlbedo) / kPiDouble;
}

PathTracerSettings with(Integrator integrator, int samples) {
    PathTracerSettings settings;
    settings.integrator = integrator;
    settings.samples_per_pixel = samples;
    settings.max_depth = 1;
    return settings;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a point light gives I cos θ / d²; a spot the same within its cone; the sun its irradiance") {
        SceneBuilder builder = floor_scene();
        builder.scene.lights.push_back(PointLight{{0, 3, 4}, Rgb(50)});
        const Scene point = builder.finish();
        const double expected = 50 * 0.6 / 25 * static_cast<double>(kAlbedo) / kPiDouble;
        for (const Integrator integrator : {Integrator::kPath, Integrator::kDirect, Integrator::kUnshadowed})
            CHECK(mean_of(render_scene(point, 4, with(integrator, 1)).radiance).g ==
                  doctest::Approx(expected).epsilon(1e-3));

        for (const bool inside : {true, false}) {
            builder = floor_scene();
            const Vec3 axis = normalize(inside ? Vec3(0, -3, -4) : Vec3(0, -3, 4));
            builder.scene.lights.push_back(SpotLight{{0, 3, 4}, axis, Rgb(50), 0.95f, 0.9f});
            CHECK(mean_of(render_scene(builder.finish(), 4, with(Integrator::kPath, 1)).radiance).g ==
                  doctest::Approx(inside ? expected : 0).epsilon(1e-3));
        }

        builder = floor_scene();
        builder.scene.lights.push_back(SunLight{normalize(Vec3(0, -3, -4)), Rgb(2)});
        CHECK(mean_of(render_scene(builder.finish(), 4, with(Integrator::kPath, 1)).radiance).g ==
              doctest::Approx(2 * 0.6 * static_cast<double>(kAlbedo) / kPiDouble).epsilon(1e-5));
    }

    TEST_CASE("what stands between casts a shadow; what stands beyond the light does not; the naive integrator finds "
              "no point light") {
        for (const float height : {1.0f, 3.5f}) {
            SceneBuilder builder = floor_scene();
            builder.add(quad({-5, height, 5}, {10, 0, 0}, {0, 0, -10}), 0);
            builder.scene.lights.push_back(PointLight{{0, 3, 0}, Rgb(50)});
            const Scene scene = builder.finish();
            const double lit = 50.0 / 9 * static_cast<double>(kAlbedo) / kPiDouble;
            CHECK(mean_of(render_scene(scene, 4, with(Integrator::kPath, 1)).radiance).g ==
                  doctest::Approx(height < 3 ? 0 : lit).epsilon(1e-3));
            CHECK(mean_of(render_scene(scene, 4, with(Integrator::kUnshadowed, 1)).radiance).g ==
                  doctest::Approx(lit).epsilon(1e-3));
            const Rendering naive = render_scene(scene, 4, with(Integrator::kNaive, 1));
            CHECK(mean_of(naive.radiance).g == 0);
            CHECK(!naive.statistics.approximations.empty());
        }
    }

    // Every shadow ray must reach its light: if a light shadowed itself, the mean would drop. Light from a quad
    // sampled uniformly by solid angle has little variance, so few samples reveal a loss of some percent.
    TEST_CASE("an emissive surface does not shade itself, nor a floor itself, at any scale") {
        for (const float scale : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f})
            for (int kind = 0; kind < 4; ++kind) {
                CAPTURE(scale);
                CAPTURE(kind);
                SceneBuilder builder = floor_scene(scale);
                const std::uint32_t area_light = builder.material(Emissive{Rgb(1.0f)});
                switch (kind) {
                case 0:
                    builder.add(quad(Vec3(-1, 1, -1) * scale, Vec3(2, 0, 0) * scale, Vec3(0, 0, 2) * scale),
                                area_light);
                    break;
                case 1:
                    builder.add(Sphere{Vec3(0.5f, 2, 0) * scale, scale}, area_light);
                    break;
                case 2:
                    builder.add(icosphere(1, scale, Vec3(0.5f, 2, 0) * scale), area_light);
                    break;
                default: // a transform with rounding
                    builder.place(builder.shape(box_quads({-1, -1, -1}, {1, 1, 1})), area_light,
                                  translation(Vec3(0.4f, 2, 0.1f) * scale) * rotation(normalize(Vec3(1, 2, 3)), 0.7f) *
                                      scaling(Vec3(0.3f, 0.3f, 0.3f) * scale));
                }
                const Scene scene = builder.finish();
                const double shadowed = mean_of(render_scene(scene, 8, with(Integrator::kDirect, 16)).radiance).g;
                const double open = mean_of(render_scene(scene, 8, with(Integrator::kUnshadowed, 16)).radiance).g;
                CHECK(open > 0);
                CHECK(shadowed == doctest::Approx(open).epsilon(0.05));
            }
    }

    TEST_CASE("a light and a panel in one place: light samples and hits agree on which is in front") {
        for (const bool area_light_first : {true, false}) {
            SceneBuilder builder = floor_scene();
            const std::uint32_t area_light = builder.material(Emissive{Rgb(1.0f)});
            builder.add(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), area_light_first ? area_light : 0);
            builder.add(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), area_light_first ? 0 : area_light);
            const Scene scene = builder.finish();
            const Estimate seen = estimate(scene, 4, with(Integrator::kNaive, 64), 4);
            const Estimate sampled = estimate(scene, 4, with(Integrator::kDirect, 64), 4);
            CHECK((seen.mean > 0) == area_light_first);
            CHECK(sampled.mean == doctest::Approx(area_light_first ? closed_form(scene) : 0).epsilon(0.02));
        }
    }

    TEST_CASE("settings can leave the environment out of background and light") {
        SceneBuilder builder = floor_scene();
        builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
        const Scene scene = builder.finish();
        for (const Integrator integrator : {Integrator::kPath, Integrator::kNaive, Integrator::kUnshadowed}) {
            PathTracerSettings settings = with(integrator, 4);
            settings.environment = false;
            View view{scene.camera, 8, 8};
            for (const double look : {0.0, 1.0}) { // at the floor, and at the sky
                view.camera.look_at = {0, look, 0};
                Control control;
                CHECK(mean_of(render(prepare(scene, settings), view, settings, control).radiance).g == 0);
                settings.environment = true;
                CHECK(mean_of(render(prepare(scene, settings), view, settings, control).radiance).g > 0.5);
                settings.environment = false;
            }
        }
    }
}

TEST_SUITE("statistical") {

    // The bound is six standard errors over ten seeds. It is exceeded by chance once in 5,000 times, and in one of 16
    // comparisons once in 300. The seeds are fixed.
    TEST_CASE("irradiance from quads, triangles and spheres is that of the closed forms") {
        for (int kind = 0; kind < 4; ++kind)
            for (const Integrator integrator :
                 {Integrator::kDirect, Integrator::kPath, Integrator::kNaive, Integrator::kUnshadowed}) {
                CAPTURE(kind);
                CAPTURE(static_cast<int>(integrator));
                SceneBuilder builder = floor_scene();
                const std::uint32_t area_light = builder.material(Emissive{Rgb(5.0f)});
                switch (kind) {
                case 0:
                    builder.add(quad({-1, 1, -0.5f}, {2, 0.2f, 0}, {0, 0, 1}), area_light);
                    break;
                case 1: // partly below the floor's horizon
                    builder.add(quad({1, -0.5f, -0.5f}, {0, 0, 1}, {0, 2, 0}), area_light);
                    break;
                case 2:
                    builder.add(Sphere{{1, 0.3f, 0}, 0.7f}, area_light);
                    break;
                default: {
                    Mesh mesh;
                    mesh.positions = {{-1, 1, -1}, {1, 1.5f, -1}, {0, 2, 1}};
                    mesh.triangles = {{0, 1, 2}};
                    builder.add(mesh, area_light);
                }
                }
                const Scene scene = builder.finish();
                REQUIRE(closed_form(scene) > 0.05);
                const Estimate e = estimate(scene, 8, with(integrator, 64));
                CHECK(std::abs(e.mean - closed_form(scene)) <= 6 * e.error + 1e-3 * closed_form(scene));
                CHECK(e.error < 0.02 * closed_form(scene));
            }
    }

    TEST_CASE("irradiance from the sky is that of the closed form; so is that from a bright patch of an image") {
        for (const bool sky : {true, false}) {
            SceneBuilder builder = floor_scene();
            double expected = 0;
            if (sky) {
                builder.scene.environment = SkyEnvironment{};
                expected = static_cast<double>(irradiance_closed_form(builder.scene.environment, {0, 1, 0})->g);
            } else {
                // The upper half of the directions has radiance 1, except for the blur of one pixel row at the
                // horizon, so E = π.
                ImageRgb image(32, 512);
                for (int y = 0; y < 256; ++y)
                    for (int x = 0; x < 32; ++x) image(x, y) = Rgb(1.0f);
                builder.scene.environment = make_image_environment(image, 1, 0);
                expected = kPiDouble;
            }
            const Scene scene = builder.finish();
            expected *= static_cast<double>(kAlbedo) / kPiDouble;
            for (const Integrator integrator : {Integrator::kPath, Integrator::kNaive, Integrator::kUnshadowed}) {
                CAPTURE(sky);
                CAPTURE(static_cast<int>(integrator));
                const Estimate e = estimate(scene, 8, with(integrator, 64));
                CHECK(std::abs(e.mean - expected) <= 6 * e.error + 1e-3 * expected);
                CHECK(e.error < 0.01 * expected);
            }
        }
    }
}

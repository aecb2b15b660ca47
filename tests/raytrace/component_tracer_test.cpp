// These tests check that the path tracer's light components add up to the image and that each has the correct value.
#include "raytrace/component_tracer.h"

#include "raytrace/render.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <functional>

using namespace duet;
using namespace duet::raytrace;

namespace {

constexpr int kSize = 20;

enum class Objects { kDiffuse, kDiffuseAndBrushed, kAll };

// Returns a corner under an area light, a point light and a sky, with spheres that cast shadows. With all objects it
// also has one of every material and a moving light, which is not sampled as a light.
Scene corner(Objects objects) {
    SceneBuilder builder;
    const std::uint32_t white = builder.material(Diffuse{{Rgb(0.7f)}});
    const std::uint32_t brushed = builder.material(Metal{{Rgb(0.9f, 0.8f, 0.7f)}, 0.5f});
    const std::uint32_t area_light = builder.material(Emissive{Rgb(3.0f), false, {Rgb(0.2f)}});
    builder.add(quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}), white);
    builder.add(quad({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}), objects == Objects::kDiffuse ? white : brushed);
    builder.add(quad({-0.6f, 2.5f, -1}, {1.2f, 0, 0}, {0, 0, 1.2f}), area_light);
    builder.add(icosphere(2, 0.5f, {-0.2f, 0.5f, 0.6f}, true), white);
    if (objects == Objects::kAll) {
        builder.add(Sphere{{-1, 0.6f, -0.8f}, 0.6f}, builder.material(Metal{{Rgb(0.9f)}, 0}));
        builder.add(Sphere{{0.8f, 0.5f, 0.2f}, 0.5f}, builder.material(Dielectric{1.5f, {Rgb(0.95f)}}));
        const std::uint32_t glow = builder.material(Emissive{Rgb(8.0f), true, {Rgb(0.3f)}});
        builder.place_moving(builder.shape(Sphere{{0, 0, 0}, 0.3f}), glow, translation(Vec3(1.2f, 1.5f, -1)),
                             translation(Vec3(1.2f, 1.0f, -0.5f)));
    }
    builder.scene.lights.push_back(PointLight{{1.5f, 2, 1.5f}, Rgb(4, 3, 2)});
    builder.scene.environment = SkyEnvironment{Rgb(0.1f), Rgb(0.4f, 0.6f, 1.0f)};
    builder.scene.camera.eye = {0.5, 1.2, 5};
    builder.scene.camera.look_at = {0, 0.9, 0};
    builder.scene.camera.fov_degrees = 40;
    return builder.finish();
}

PathTracerSettings with(int samples, int depth = 6) {
    PathTracerSettings settings;
    settings.samples_per_pixel = samples;
    settings.max_depth = depth;
    return settings;
}

View view_of(const Scene& scene) { return {scene.camera, kSize, kSize}; }

/// A GetLight extracts a quantity from a camera sample, and mean_over_samples() averages it over an image.
using GetLight = std::function<Rgb(const PixelSample&)>;
Rgbd mean_over_samples(const Scene& scene, const PathTracerSettings& settings, const GetLight& get_light) {
    const ComponentTracer tracer(prepare(scene, settings), view_of(scene), settings);
    Rgbd sum;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            for (int i = 0; i < settings.samples_per_pixel; ++i)
                sum += Rgbd(get_light(tracer.sample(x, y, static_cast<std::uint32_t>(i))));
    return sum / (1.0 * kSize * kSize * settings.samples_per_pixel);
}

/// Returns the green channel's mean and standard error over the seeds, as estimate() does.
Estimate estimate_component(const Scene& scene, PathTracerSettings settings, const GetLight& get_light,
                            int seeds = 10) {
    std::vector<double> means;
    for (int seed = 0; seed < seeds; ++seed) {
        settings.seed = static_cast<std::uint64_t>(100 + seed);
        means.push_back(mean_over_samples(scene, settings, get_light).g);
    }
    Estimate e;
    for (const double m : means) e.mean += m / seeds;
    double squares = 0;
    for (const double m : means) squares += sqr(m - e.mean);
    e.error = std::sqrt(squares / (seeds - 1) / seeds);
    return e;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the parts add up to the path tracer's image, sample by sample the same numbers") {
        const Scene scene = corner(Objects::kAll);
        for (const bool environment : {true, false}) {
            PathTracerSettings settings = with(6);
            settings.environment = environment;
            settings.seed = 5;
            const ImageRgb shown_image = render_scene(scene, kSize, settings).radiance;
            const ComponentTracer tracer(prepare(scene, settings), view_of(scene), settings);
            double largest = 0;
            for (int y = 0; y < kSize; ++y)
                for (int x = 0; x < kSize; ++x) {
                    Rgbd sum;
                    for (std::uint32_t i = 0; i < 6; ++i) sum += Rgbd(tracer.sample(x, y, i).light.sum());
                    for (std::size_t c = 0; c < 3; ++c) {
                        const double expected = static_cast<double>(shown_image(x, y)[c]);
                        largest = std::max(largest, std::abs(sum[c] / 6 - expected) / (expected + 1e-3));
                    }
                }
            CHECK(largest < 2e-6);
        }
    }

    TEST_CASE("each part comes by its own way") {
        const Scene scene = corner(Objects::kAll);
        const PathTracerSettings settings = with(4);
        const ComponentTracer tracer(prepare(scene, settings), view_of(scene), settings);
        LightComponents total;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x)
                for (std::uint32_t i = 0; i < 4; ++i) {
                    const PixelSample sample = tracer.sample(x, y, i);
                    const LightComponents& light = sample.light;
                    CHECK(sample.surface.has_value() == sample.hit.valid());
                    if (!sample.surface) {
                        CHECK(light.sum() == light.emission);
                        continue;
                    }
                    const Bsdf& bsdf = sample.surface->bsdf;
                    if (std::holds_alternative<DiffuseBsdf>(bsdf)) {
                        CHECK(is_black(light.reflection));
                    } else {
                        CHECK(is_black(light.environment));
                        CHECK(is_black(light.indirect));
                    }
                    if (is_specular(bsdf)) {
                        CHECK(is_black(light.direct));
                        CHECK(is_black(light.shadowed));
                    }
                    total.direct += light.direct;
                    total.environment += light.environment;
                    total.reflection += light.reflection;
                    total.indirect += light.indirect;
                    total.shadowed += light.shadowed;
                }
        for (const Rgb& part : {total.direct, total.environment, total.reflection, total.indirect, total.shadowed})
            CHECK(part.g > 1);
    }

    TEST_CASE("a moving light is no light of the scene: what it sends counts as indirect") {
        SceneBuilder builder;
        builder.add(quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}), builder.material(Diffuse{{Rgb(0.7f)}}));
        builder.place_moving(builder.shape(Sphere{{0, 0, 0}, 0.5f}), builder.material(Emissive{Rgb(8.0f)}),
                             translation(Vec3(0, 1, 0)), translation(Vec3(0.5f, 1, 0)));
        builder.scene.camera.eye = {0.5, 1.2, 5};
        const Scene scene = builder.finish();
        const auto direct = [](const PixelSample& s) { return s.light.direct + s.light.shadowed; };
        CHECK(is_black(mean_over_samples(scene, with(16), direct)));
        CHECK(mean_over_samples(scene, with(16), [](const PixelSample& s) { return s.light.indirect; }).g > 0.01);
    }

    TEST_CASE("with one scattering a diffuse scene has no indirect light; with none, emission alone") {
        const Scene scene = corner(Objects::kDiffuse);
        const auto indirect = [](const PixelSample& s) { return s.light.indirect + s.light.reflection; };
        CHECK(is_black(mean_over_samples(scene, with(4, 1), indirect)));
        CHECK(!is_black(mean_over_samples(scene, with(4, 2), indirect)));
        CHECK(mean_over_samples(scene, with(4, 0), [](const PixelSample& s) { return s.light.sum(); }) ==
              mean_over_samples(scene, with(4), [](const PixelSample& s) { return s.light.emission; }));
    }

    TEST_CASE("the reflection integrator shows the part of the same numbers") {
        const Scene scene = corner(Objects::kAll);
        PathTracerSettings settings = with(4);
        const Rgbd part = mean_over_samples(scene, settings, [](const PixelSample& s) { return s.light.reflection; });
        settings.integrator = Integrator::kReflection;
        const Rgbd alone = mean_of(render_scene(scene, kSize, settings).radiance);
        CHECK(alone.g > 0.01);
        CHECK(alone.g == doctest::Approx(part.g).epsilon(1e-5));
    }

    TEST_CASE("a point light behind a blocker: all of its light is shadowed, and as much as without the blocker") {
        for (const bool blocked : {false, true}) {
            SceneBuilder builder;
            const std::uint32_t grey = builder.material(Diffuse{{Rgb(0.5f)}});
            builder.add(quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), grey);
            if (blocked) builder.add(quad({-3, 1, 3}, {6, 0, 0}, {0, 0, -6}), grey);
            builder.scene.lights.push_back(PointLight{{0, 2, 0}, Rgb(10)});
            Camera& camera = builder.scene.camera;
            camera.projection = Camera::Projection::kOrthographic;
            camera.eye = {0, 0.5, 0};
            camera.look_at = {0, 0, 0};
            camera.up = {0, 0, -1};
            camera.height = 1e-3;
            const Scene scene = builder.finish();
            const double expected = 10.0 / 4 * 0.5 / kPiDouble;
            const auto direct = [](const PixelSample& s) { return s.light.direct; };
            const auto shadowed = [](const PixelSample& s) { return s.light.shadowed; };
            CHECK(mean_over_samples(scene, with(1), direct).g == doctest::Approx(blocked ? 0 : expected).epsilon(1e-4));
            CHECK(mean_over_samples(scene, with(1), shadowed).g ==
                  doctest::Approx(blocked ? expected : 0).epsilon(1e-4));
        }
    }
}

TEST_SUITE("statistical") {

    // Each bound is six standard errors over ten seeds each, which is exceeded by chance once in 90,000 times. The
    // other estimator chooses its lights differently or has no components.
    TEST_CASE("emission and unshadowed light are what the unshadowed integrator finds, emission and direct light what "
              "the lights integrator finds, by diffuse surfaces and rough metal") {
        const Scene scene = corner(Objects::kDiffuseAndBrushed);
        const PathTracerSettings settings = with(16);
        PathTracerSettings alone = with(32);
        alone.environment = false;
        const PathTracerSettings split = [&] {
            PathTracerSettings s = settings;
            s.environment = false; // the background counts as emission, too
            return s;
        }();
        alone.integrator = Integrator::kUnshadowed;
        const Estimate unshadowed = estimate(scene, kSize, alone);
        const GetLight whole = [](const PixelSample& s) { return s.light.emission + s.light.unshadowed(); };
        check_equal_means(estimate_component(scene, split, whole), unshadowed);
        alone.integrator = Integrator::kLights;
        const Estimate lights = estimate(scene, kSize, alone);
        const GetLight lit = [](const PixelSample& s) { return s.light.emission + s.light.direct; };
        check_equal_means(estimate_component(scene, split, lit), lights);
        // Including the environment among the lights must change neither result.
        const GetLight open = [](const PixelSample& s) { return s.light.unshadowed(); };
        check_equal_means(estimate_component(scene, settings, open), estimate_component(scene, split, open));
        CHECK(unshadowed.mean > lights.mean * 1.02); // shadows are present
        CHECK(lights.error < 0.01 * lights.mean);
    }

    TEST_CASE("environment light is what the environment integrator finds, and what is left of direct light in a "
              "scene without lights") {
        Scene scene = corner(Objects::kDiffuse);
        PathTracerSettings alone = with(32);
        alone.integrator = Integrator::kEnvironment;
        const Estimate environment = estimate(scene, kSize, alone);
        const GetLight get_light = [](const PixelSample& s) { return s.light.environment; };
        const Estimate part = estimate_component(scene, with(16), get_light);
        CHECK(environment.mean > 0.05);
        CHECK(environment.error < 0.01 * environment.mean);
        check_equal_means(part, environment);
        // Naive path tracing of one scattering event finds all direct light except that of point lights.
        alone.integrator = Integrator::kNaive;
        alone.samples_per_pixel = 128;
        alone.max_depth = 1;
        const GetLight found = [](const PixelSample& s) {
            return s.light.environment + s.light.direct + s.light.emission;
        };
        scene.lights.erase(scene.lights.begin());
        --scene.first_surface_light;
        check_equal_means(estimate_component(scene, with(16), found), estimate(scene, kSize, alone));
    }

    TEST_CASE("indirect light of diffuse surfaces is whole paths less direct ones") {
        const Scene scene = corner(Objects::kDiffuse);
        PathTracerSettings direct = with(32);
        direct.integrator = Integrator::kDirect;
        const Estimate one = estimate(scene, kSize, direct), all = estimate(scene, kSize, with(32));
        const GetLight indirect = [](const PixelSample& s) { return s.light.indirect; };
        const Estimate part = estimate_component(scene, with(16), indirect);
        const Estimate rest{all.mean - one.mean, std::sqrt(sqr(all.error) + sqr(one.error))};
        CHECK(part.mean > 0.02);
        check_equal_means(part, rest);
    }
}

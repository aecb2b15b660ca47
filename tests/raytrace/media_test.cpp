// These tests check images of media against closed forms and independent numerical integrals. Where a comparison is
// statistical, the estimate has ten seeds: it fails by chance if it is off by six standard errors, once in 5,000 times.
#include "common/image/bitwise_equal.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/h_function.h"
#include "tests/raytrace/media.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

/// Returns a scene whose camera looks along −z from z = 3·scale, through so narrow an angle that all pixels see the
/// same.
SceneBuilder looking_down_z(float scale = 1) {
    SceneBuilder builder;
    builder.scene.camera.eye = Vec3d(0, 0, 3) * static_cast<double>(scale);
    builder.scene.camera.look_at = {0, 0, 0};
    builder.scene.camera.fov_degrees = 0.01;
    builder.material(Diffuse{{Rgb(0.0f)}}); // a scene has a material
    return builder;
}
PathTracerSettings path_settings(int samples, int depth = 64) {
    PathTracerSettings settings;
    settings.samples_per_pixel = samples;
    settings.max_depth = depth;
    return settings;
}

void check_close(const Estimate& found, double truth, double tolerance = 1e-5) {
    CAPTURE(found.mean);
    CAPTURE(found.error);
    CAPTURE(truth);
    CHECK(std::abs(found.mean - truth) < 6 * found.error + tolerance * std::abs(truth));
    CHECK(found.error < 5e-3 * truth);
}

/// Returns the radiance that a fog without bounds within ±half of z scatters from a point light toward the camera, by
/// the midpoint rule: ∫ σs p(cos θ) exp(−σt (t + r)) I / r² dt.
double single_scattering(const Medium& medium, Vec3d light, double intensity, double half) {
    const double scattering = static_cast<double>(medium.scattering.g);
    const double extinction = scattering + static_cast<double>(medium.absorption.g);
    const int steps = 200000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double along = 2 * half * (i + 0.5) / steps; // from the front of the fog
        const Vec3d p(0, 0, half - along);
        const Vec3d to_light = light - p;
        const double r = length(to_light), cosine = -to_light.z / r;
        const double g = static_cast<double>(medium.asymmetry);
        const double phase = (1 - g * g) / (4 * kPiDouble * std::pow(1 + g * g - 2 * g * cosine, 1.5));
        sum += scattering * phase * std::exp(-extinction * (along + r)) * intensity / (r * r);
    }
    return sum * 2 * half / steps;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("Media that only absorb have no noise: the law of Beer and Lambert") {
        for (const float scale : {1e-6f, 1e-3f, 1.0f, 1e6f}) {
            CAPTURE(scale);
            SceneBuilder builder = looking_down_z(scale);
            builder.scene.environment = ConstantEnvironment{Rgb(2.0f)};
            builder.scene.media = {
                fog(cube(scale), Rgb(0.0f), Rgb(0.1f, 0.7f, 2) * (1 / scale)),
                fog({Vec3(-9, -9, -9) * scale, Vec3(9, 9, 0) * scale}, Rgb(0.0f), Rgb(0.02f / scale))};
            const Rgb color = render_scene(builder.finish(), 2, path_settings(3)).radiance(1, 1);
            const double shared = 9 * 0.02;
            CHECK(static_cast<double>(color.r) == doctest::Approx(2 * std::exp(-0.2 - shared)).epsilon(1e-5));
            CHECK(static_cast<double>(color.g) == doctest::Approx(2 * std::exp(-1.4 - shared)).epsilon(1e-5));
            CHECK(static_cast<double>(color.b) == doctest::Approx(2 * std::exp(-4 - shared)).epsilon(1e-5));
        }
    }

    TEST_CASE("A medium that glows has its radiance times what it absorbs") {
        SceneBuilder builder = looking_down_z();
        Medium flame = fog(cube(1), Rgb(0.0f), Rgb(1e-6f, 0.5f, 1e6f));
        flame.radiance = Rgb(3.0f);
        builder.scene.media = {flame};
        const Scene scene = builder.finish();
        for (const int depth : {0, 1, 64}) {
            const Rgb color = render_scene(scene, 2, path_settings(3, depth)).radiance(0, 1);
            CHECK(static_cast<double>(color.r) == doctest::Approx(6e-6).epsilon(1e-5));
            CHECK(static_cast<double>(color.g) == doctest::Approx(3 * (1 - std::exp(-1.0))).epsilon(1e-5));
            CHECK(static_cast<double>(color.b) == doctest::Approx(3).epsilon(1e-5));
        }
    }

    TEST_CASE("Glass displaces fog") {
        // Glass of index 1 does nothing else. The ray passes 4 m of fog, 2 of which are a ball of glass.
        SceneBuilder builder = looking_down_z();
        builder.add(Sphere{{0, 0, 0}, 1}, builder.material(Dielectric{1.0f, {Rgb(1.0f)}}));
        builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
        builder.scene.media = {fog(cube(2), Rgb(0.0f), Rgb(0.3f))};
        const Rgb color = render_scene(builder.finish(), 2, path_settings(3)).radiance(0, 0);
        CHECK(static_cast<double>(color.g) == doctest::Approx(std::exp(-0.6)).epsilon(1e-5));
    }

    TEST_CASE("Images with media have the same bits for any number of threads") {
        SceneBuilder builder = looking_down_z();
        builder.scene.camera.fov_degrees = 60;
        builder.add(quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}), builder.material(Diffuse{{Rgb(0.6f)}}));
        builder.add(Sphere{{0.4f, 0, 0}, 0.5f}, builder.material(Dielectric{1.5f, {Rgb(1.0f)}}));
        builder.scene.lights = {PointLight{{-0.5f, 0.8f, 0}, Rgb(2.0f)}, SunLight{{0, -1, 0}, Rgb(1.0f)}};
        builder.scene.environment = SkyEnvironment{};
        builder.scene.media = {fog(cube(1.5f), Rgb(0.4f, 0.2f, 0.1f), Rgb(0.1f), 0.6f),
                               fog(cube(1), Rgb(0.2f), Rgb(0.0f)), bell(cube(0.7f), 3)};
        const Scene scene = builder.finish();
        PathTracerSettings settings = path_settings(4);
        settings.threads = 1;
        const ImageRgb one = render_scene(scene, 40, settings).radiance;
        settings.threads = 3;
        CHECK(bitwise_equal(one, render_scene(scene, 40, settings).radiance));
        for (const Rgb& pixel : one) CHECK(is_finite(pixel));
    }
}

TEST_SUITE("statistical") {
    TEST_CASE("A sun's light that colored fog scatters once equals the integral of each channel") {
        // From a half space, that is σs/(4π) / (2 σt) for light along the view: also far behind the depth at which the
        // fog is opaque in another channel.
        SceneBuilder builder = looking_down_z();
        const Rgb scattering(3, 0.03f, 0.3f), absorption(1, 0.0f, 0.1f);
        builder.scene.media = {fog({{-1e4f, -1e4f, -1e4f}, {1e4f, 1e4f, 0}}, scattering, absorption)};
        builder.scene.lights = {SunLight{{0, 0, -1}, Rgb(1.0f)}};
        const Scene scene = builder.finish();
        Rgbd sum, squares;
        constexpr int kSeeds = 10;
        for (int seed = 0; seed < kSeeds; ++seed) {
            PathTracerSettings settings = path_settings(4096, 1);
            settings.seed = static_cast<std::uint64_t>(seed);
            const Rgbd color(render_scene(scene, 1, settings).radiance(0, 0));
            sum += color, squares += color * color;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const double s = static_cast<double>(scattering[c]), sigma = s + static_cast<double>(absorption[c]);
            const double truth = s / (8 * kPiDouble * sigma), mean = sum[c] / kSeeds;
            const double error = std::sqrt(std::max(squares[c] / kSeeds - mean * mean, 0.0) / kSeeds);
            CAPTURE(c);
            CHECK(std::abs(mean - truth) < 6 * error + 1e-4 * truth);
            CHECK(error < 0.01 * truth);
        }
    }

    TEST_CASE("Fog that is opaque at once scatters like a surface") {
        // What a sun scatters once is σs / (8π σt), however short the way is in floats.
        // From about 1e9 mean free paths on, the light's own way through the fog is lost to rounding.
        for (const float extinction : {1e3f, 1e6f, 1e9f, 1e12f}) {
            CAPTURE(extinction);
            SceneBuilder builder = looking_down_z();
            builder.scene.media = {fog(cube(1), Rgb(0.8f * extinction), Rgb(0.2f * extinction))};
            builder.scene.lights = {SunLight{{0, 0, -1}, Rgb(1.0f)}};
            const Estimate found = estimate(builder.finish(), 4, path_settings(256, 1));
            const double truth = 0.8 / (8 * kPiDouble);
            if (extinction < 1e8f) check_close(found, truth, 0.01);
            CHECK(found.mean > 0.99 * truth);
            CHECK(found.mean < 2.01 * truth);
        }
    }

    TEST_CASE("A spot light's single scattering in a cloud equals a numerical integral") {
        SceneBuilder builder = looking_down_z();
        const Medium cloud = bell(cube(1), 2, 0.5f);
        const Vec3 position(0.3f, 1.5f, 0.2f);
        const SpotLight spot{position, normalize(Vec3(-0.2f, -1, -0.1f)), Rgb(5.0f), 0.9f, 0.8f};
        builder.scene.media = {cloud};
        builder.scene.lights = {spot};
        double truth = 0;
        constexpr int kSteps = 4000;
        const Ray view{{0, 0, 3}, {0, 0, -1}};
        for (int i = 0; i < kSteps; ++i) {
            const float t = 2 + 2 * (static_cast<float>(i) + 0.5f) / kSteps;
            const Vec3 p = view.at(t);
            const std::optional<LightSample> light = sample_light(spot, p, {});
            if (!light) continue;
            const Rgb through = transmittance(builder.scene.media, view, t) *
                                transmittance(builder.scene.media, Ray{p, light->wi}, light->distance);
            truth +=
                static_cast<double>(2 * density_at(cloud, p) * kInvPi / 4 * (through * light->radiance).g) * 2 / kSteps;
        }
        REQUIRE(truth > 0);
        check_close(estimate(builder.finish(), 4, path_settings(4096, 1)), truth, 2e-3);
    }

    TEST_CASE("Light of a point light that fog scatters once equals a numerical integral") {
        for (const float scale : {1e-6f, 1.0f, 1e6f})
            for (const float g : {-0.7f, 0.0f, 0.9f})
                for (const float extinction : {0.05f, 1.0f, 30.0f}) {
                    CAPTURE(scale);
                    CAPTURE(g);
                    CAPTURE(extinction);
                    SceneBuilder builder = looking_down_z(scale);
                    const Medium medium =
                        fog(cube(scale), Rgb(0.8f * extinction / scale), Rgb(0.2f * extinction / scale), g);
                    builder.scene.media = {medium};
                    builder.scene.lights = {PointLight{Vec3(0.3f, 0.1f, 0.7f) * scale, Rgb(5 * scale * scale)}};
                    const double s = static_cast<double>(scale);
                    const double truth = single_scattering(medium, Vec3d(Vec3(0.3f, 0.1f, 0.7f) * scale), 5 * s * s, s);
                    check_close(estimate(builder.finish(), 4, path_settings(256, 1)), truth, 1e-4);
                }
    }

    TEST_CASE("Fog that absorbs nothing is invisible in a white furnace") {
        for (const float g : {-0.8f, 0.0f, 0.8f})
            for (const float scattering : {0.1f, 3.0f}) {
                CAPTURE(g);
                SceneBuilder builder = looking_down_z();
                builder.scene.camera.fov_degrees = 50;
                builder.add(Sphere{{0.2f, 0, 0}, 0.4f}, builder.material(Diffuse{{Rgb(1.0f)}}));
                builder.add(Sphere{{-0.6f, 0.3f, 0}, 0.3f}, builder.material(Dielectric{1.5f, {Rgb(1.0f)}}));
                builder.scene.media = {fog(cube(1), Rgb(0.5f * scattering, scattering, 0.0f), Rgb(0.0f), g)};
                builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
                check_close(estimate(builder.finish(), 16, path_settings(64, 1000)), 1);
            }
    }

    TEST_CASE("A cloud that absorbs nothing is invisible in a white furnace") {
        SceneBuilder builder = looking_down_z();
        builder.scene.camera.fov_degrees = 50;
        builder.add(Sphere{{0.2f, 0, 0}, 0.4f}, builder.material(Diffuse{{Rgb(1.0f)}}));
        Medium cloud = bell(cube(1), 8);
        cloud.asymmetry = 0.7f;
        builder.scene.media = {cloud, fog(cube(0.5f), Rgb(0.2f, 1, 0.5f), Rgb(0.0f))};
        builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
        check_close(estimate(builder.finish(), 16, path_settings(64, 1000)), 1);
    }

    TEST_CASE("A cloud of even density is fog") {
        for (const float scale : {1e-6f, 1.0f, 1e6f}) {
            CAPTURE(scale);
            const auto image_with = [&](std::shared_ptr<const DensityGrid> density) {
                SceneBuilder builder = looking_down_z(scale);
                builder.scene.camera.fov_degrees = 40;
                builder.add(Sphere{Vec3(0, -0.3f, 0) * scale, 0.4f * scale}, builder.material(Diffuse{{Rgb(0.7f)}}));
                builder.scene.lights = {PointLight{Vec3(0.5f, 0.6f, 0.2f) * scale, Rgb(5 * scale * scale)},
                                        SunLight{{-0.6f, -0.8f, 0}, Rgb(1.0f)}};
                builder.scene.environment = SkyEnvironment{Rgb(0.2f), Rgb(0.5f)};
                Medium medium = fog(cube(scale), Rgb(0.9f, 0.5f, 0.3f) * (1 / scale), Rgb(0.1f / scale), 0.5f);
                medium.density = std::move(density);
                builder.scene.media = {medium};
                return estimate(builder.finish(), 16, path_settings(256));
            };
            const Estimate a = image_with(nullptr);
            const Estimate b =
                image_with(std::make_shared<const DensityGrid>(std::array{5, 12, 20}, std::vector<float>(1200, 1.0f)));
            check_equal_means(a, b);
            CHECK(b.error < 5e-3 * b.mean);
        }
    }

    TEST_CASE("A deep layer of fog reflects what Chandrasekhar's H function says") {
        // The camera and a sun look straight down at 30 mean free paths of fog, 100 times as wide as deep.
        const float albedo = 0.9f;
        SceneBuilder builder = looking_down_z();
        builder.scene.media = {fog({{-1000, -1000, -30}, {1000, 1000, 0}}, Rgb(albedo), Rgb(1 - albedo))};
        builder.scene.lights = {SunLight{{0, 0, -1}, Rgb(1.0f)}};
        const double h = HFunction(static_cast<double>(albedo))(1);
        const double truth = static_cast<double>(albedo) / (4 * kPiDouble) * 0.5 * h * h;
        check_close(estimate(builder.finish(), 8, path_settings(1024, 1000)), truth, 1e-3);
    }

    TEST_CASE("All ways to find light in fog agree") {
        // The naive path tracer finds area lights and the environment by chance.
        for (const float g : {0.0f, 0.8f}) {
            SceneBuilder builder = looking_down_z();
            builder.scene.camera.fov_degrees = 40;
            const std::uint32_t white = builder.material(Diffuse{{Rgb(0.7f)}});
            builder.add(quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}), white);
            builder.add(Sphere{{0, -0.3f, 0}, 0.4f}, builder.material(Metal{{Rgb(0.9f)}, 0.4f}));
            builder.add(quad({-0.5f, 0.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}), builder.material(Emissive{Rgb(6.0f)}));
            builder.scene.environment = SkyEnvironment{Rgb(0.2f), Rgb(0.5f)};
            builder.scene.media = {fog(cube(1.2f), Rgb(0.9f, 0.5f, 0.3f), Rgb(0.1f), g), bell(cube(1), 1)};
            check_against_naive(builder.finish(), 16, path_settings(256), 1024, 5e-3);
        }
    }
}

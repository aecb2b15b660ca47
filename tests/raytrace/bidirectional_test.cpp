// These tests compare bidirectional path tracing with the path tracer: both must converge to the same image, whatever
// emits, scatters and moves.
#include "common/image/bitwise_equal.h"
#include "common/system/error.h"
#include "raytrace/bidirectional/bidirectional_pass.h"
#include "raytrace/bidirectional/light_emission.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <atomic>
#include <string>
#include <utility>
#include <vector>

using namespace duet;
using namespace duet::raytrace;

namespace {

// Returns a room without front and ceiling, of diffuse, rough metallic and coated walls.
SceneBuilder room() {
    SceneBuilder builder;
    builder.add(quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}), builder.material(Diffuse{{Rgb(0.7f, 0.6f, 0.5f)}}));
    builder.add(quad({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}), builder.material(Metal{{Rgb(0.8f)}, 0.4f}));
    Principled plastic;
    plastic.base_color = RgbSlot{Rgb(0.3f, 0.5f, 0.8f)};
    builder.add(quad({-2, 0, 2}, {0, 0, -4}, {0, 3, 0}), builder.material(plastic));
    builder.scene.camera.eye = {0.3, 1.4, 6};
    builder.scene.camera.look_at = {0, 0.9, 0};
    builder.scene.camera.fov_degrees = 35;
    return builder;
}

Scene under_surface_lights() {
    SceneBuilder builder = room();
    const std::uint32_t front = builder.material(Emissive{Rgb(6.0f)});
    const std::uint32_t both = builder.material(Emissive{Rgb(3.0f), true});
    builder.add(quad({-0.5f, 2.8f, -0.5f}, {1, 0, 0}, {0, 0, 1}), front);
    builder.add(Sphere{{0.9f, 0.8f, -0.5f}, 0.15f}, front);
    Mesh triangle;
    triangle.positions = {{-1.2f, 1.5f, -1}, {-0.6f, 1.6f, -1.1f}, {-0.9f, 2.1f, -0.8f}};
    triangle.triangles = {{0, 1, 2}};
    builder.add(std::move(triangle), both);
    builder.add(Sphere{{-0.4f, 0.5f, 0.5f}, 0.5f}, builder.material(Diffuse{{Rgb(0.6f)}}));
    return builder.finish();
}

Scene under_delta_lights() {
    SceneBuilder builder = room();
    builder.scene.lights = {PointLight{{0.6f, 2, 0.5f}, Rgb(4.0f)},
                            SpotLight{{-1, 2.5f, 1.5f}, normalize(Vec3(0.4f, -1, -0.6f)), Rgb(20.0f), 0.9f, 0.7f},
                            SunLight{normalize(Vec3(0.3f, -1, -0.5f)), Rgb(1.5f, 1.4f, 1.2f)}};
    builder.add(icosphere(2, 0.6f, {0, 0.7f, 0}, true), builder.material(Metal{{Rgb(0.9f, 0.7f, 0.4f)}, 0.5f}));
    return builder.finish();
}

Scene under_an_image() {
    SceneBuilder builder = room();
    builder.add(icosphere(2, 0.6f, {0, 0.7f, 0}, true), builder.material(Diffuse{{Rgb(0.8f)}}));
    ImageRgb sky(32, 16, Rgb(0.2f, 0.3f, 0.5f));
    for (int x = 5; x < 9; ++x)
        for (int y = 3; y < 6; ++y) sky(x, y) = Rgb(20.0f);
    builder.scene.environment = make_image_environment(sky, 1, 0.3f);
    return builder.finish();
}

// Returns caustics of smooth and rough glass and of a mirror, through a lens, while a ball moves.
Scene glass_in_motion() {
    SceneBuilder builder = room();
    builder.add(Sphere{{-0.8f, 0.5f, 0.4f}, 0.5f}, builder.material(Dielectric{}));
    Dielectric frosted;
    frosted.roughness = ScalarSlot{0.3f};
    builder.add(Sphere{{0.4f, 0.5f, 0.6f}, 0.5f}, builder.material(frosted));
    builder.add(quad({0.9f, 0, 0.5f}, {0.5f, 0, -0.8f}, {0, 1, 0}), builder.material(Metal{{Rgb(0.9f)}}));
    const std::uint32_t ball = builder.shape(Sphere{{0, 0.3f, -0.8f}, 0.3f});
    builder.place_moving(ball, builder.material(Diffuse{{Rgb(0.5f, 0.8f, 0.4f)}}), Mat4(),
                         Mat4(translation(Vec3d(0.4, 0.2, 0))));
    builder.add(quad({-0.3f, 2.5f, 0}, {0.6f, 0, 0}, {0, 0, 0.6f}), builder.material(Emissive{Rgb(20.0f)}));
    builder.scene.camera.aperture_radius = 0.05;
    return builder.finish();
}

// Returns a ball that moves fast below an area light. Its shadow moves with it.
Scene fast_ball() {
    SceneBuilder builder = room();
    const std::uint32_t ball = builder.shape(Sphere{{-0.8f, 1, 0}, 0.4f});
    builder.place_moving(ball, builder.material(Diffuse{{Rgb(0.7f)}}), Mat4(), Mat4(translation(Vec3d(1.6, 0.3, 0))));
    builder.add(quad({-0.5f, 2.9f, 0.2f}, {1, 0, 0}, {0, 0, 1}), builder.material(Emissive{Rgb(8.0f)}));
    return builder.finish();
}

// Returns a ball of 20 triangles with vertex normals. Lights and camera graze its triangles.
Scene coarse_smooth_ball() {
    SceneBuilder builder;
    builder.add(icosphere(0, 1, {0, 0, 0}, true), builder.material(Diffuse{{Rgb(0.8f)}}));
    builder.add(quad({2, -2, 2}, {0, 0, -4}, {0, 4, 0}), builder.material(Diffuse{{Rgb(0.9f)}}));
    builder.add(quad({-3, 1, 0.5f}, {0, 1, 0}, {0, 0, -1}), builder.material(Emissive{Rgb(30.0f), true}));
    builder.scene.camera.eye = {0, 0, 4};
    builder.scene.camera.fov_degrees = 35;
    return builder.finish();
}

// Returns a point light that lies in a tilted black floor. Rounding errors put it on one side or the other.
Scene light_in_a_floor() {
    SceneBuilder builder;
    const Vec3 u(1, 0.1f, 0.05f), v(0.02f, 0.3f, -1);
    builder.add(quad(u * -1.0f + v * -1.0f, u * 2.0f, v * 2.0f), builder.material(Diffuse{{Rgb(0.0f)}}));
    builder.add(quad({-3, 2.5f, -3}, {0, 0, 6}, {6, 0, 0}), builder.material(Diffuse{{Rgb(0.7f)}}));
    builder.scene.lights = {PointLight{u * 0.03f + v * 0.02f, Rgb(3.0f)}};
    builder.scene.camera.eye = {0, 0.8, 5};
    builder.scene.camera.look_at = {0, 1.5, 0};
    return builder.finish();
}

// Returns light that sends no photons, beside some that does: an even sky, and an emitter that moves. Some surfaces are
// almost mirrors.
Scene partly_without_photons() {
    SceneBuilder builder = room();
    builder.scene.environment = ConstantEnvironment{Rgb(0.2f, 0.3f, 0.4f)};
    const std::uint32_t glow = builder.shape(Sphere{{-0.8f, 2, 0.5f}, 0.3f});
    builder.place_moving(glow, builder.material(Emissive{Rgb(2.0f)}), Mat4(), Mat4(translation(Vec3d(0.4, 0.1, 0))));
    builder.add(quad({0.3f, 2.8f, -0.5f}, {1, 0, 0}, {0, 0, 1}), builder.material(Emissive{Rgb(6.0f)}));
    builder.add(Sphere{{-0.5f, 0.7f, 0.5f}, 0.5f}, builder.material(Metal{{Rgb(0.9f)}, 0.15f}));
    Coated varnish;
    varnish.albedo = RgbSlot{Rgb(0.6f, 0.2f, 0.1f)};
    builder.add(Sphere{{0.7f, 0.7f, 0.5f}, 0.5f}, builder.material(varnish));
    return builder.finish();
}

// Returns a square floor, seen from above, that a sun lights directly and by way of a mirror beside it.
constexpr float kSunRadiance = 0.5f;
Scene floor_beside_a_mirror() {
    SceneBuilder builder;
    builder.add(quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), builder.material(Diffuse{{Rgb(0.5f)}}));
    builder.add(quad({3, 1.9f, 1.1f}, {0, 0, -2.2f}, {0, 2.2f, 0}), builder.material(Metal{{Rgb(1.0f)}}));
    const Vec3 direction = normalize(Vec3(1, -1, 0));
    builder.scene.lights = {SunLight{direction, Rgb(kSunRadiance * kPi / (0.5f * -direction.y))}};
    builder.scene.camera.projection = Camera::Projection::kOrthographic;
    builder.scene.camera.eye = {0, 4, 0};
    builder.scene.camera.up = {0, 0, -1};
    return builder.finish();
}

Scene seen_in_parallel() {
    Scene scene = under_surface_lights();
    scene.camera.projection = Camera::Projection::kOrthographic;
    scene.camera.height = 3;
    return scene;
}

PathTracerSettings bidirectional(int samples, Integrator integrator = Integrator::kBidirectional) {
    PathTracerSettings settings;
    settings.integrator = integrator;
    settings.samples_per_pixel = samples;
    return settings;
}

/// Names an integrator, and says with how many samples its image is compared with the path tracer's.
struct Comparison {
    Integrator integrator;
    int size, path_samples, samples;
    double largest_error; ///< standard error of the image's mean, relative
};

/// Compares an image's mean with the path tracer's. The bound is six standard errors of the difference over ten seeds
/// each, which is exceeded by chance once in 90,000 times, and this fraction of the mean.
void check_converges(const Scene& scene, int depth, const Comparison& comparison, double tolerance) {
    PathTracerSettings settings;
    settings.max_depth = depth;
    settings.samples_per_pixel = comparison.path_samples;
    const Estimate path = estimate(scene, comparison.size, settings);
    settings.integrator = comparison.integrator;
    settings.samples_per_pixel = comparison.samples;
    const Estimate found = estimate(scene, comparison.size, settings);
    CAPTURE(depth);
    CAPTURE(path.mean);
    CAPTURE(path.error);
    CAPTURE(found.mean);
    CAPTURE(found.error);
    CHECK(std::abs(path.mean - found.mean) < 6 * std::hypot(path.error, found.error) + tolerance * path.mean);
    CHECK(found.error < comparison.largest_error * found.mean);
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("the bits do not depend on threads, and a continued film has those of one run") {
        for (const Integrator integrator :
             {Integrator::kBidirectional, Integrator::kVcm, Integrator::kPhotons, Integrator::kMetropolis}) {
            const Scene scene = glass_in_motion();
            PathTracerSettings settings = bidirectional(6, integrator);
            settings.threads = 1;
            const ImageRgb one = render_scene(scene, 80, settings).radiance;
            settings.threads = 3;
            CHECK(bitwise_equal(one, render_scene(scene, 80, settings).radiance));

            const test::ScratchFolder folder;
            settings.film = folder / "film.exr";
            for (const int samples : {1, 4, 6}) {
                settings.samples_per_pixel = samples;
                const ImageRgb image = render_scene(scene, 80, settings).radiance;
                CHECK(bitwise_equal(one, image) == (samples == 6));
            }
        }
    }

    TEST_CASE("a stopped sample leaves no trace in the film") {
        const Scene scene = under_delta_lights();
        const std::atomic<bool> stop = true;
        Control control;
        control.stop = &stop;
        const Rendering stopped =
            render(prepare(scene, bidirectional(4)), View{scene.camera, 16, 16}, bidirectional(4), control);
        CHECK(stopped.statistics.interrupted);
        for (const Rgb& pixel : stopped.radiance) CHECK(is_black(pixel));
    }

    TEST_CASE("the radius of merging does not depend on how far away the point is that the camera looks at") {
        Scene scene = under_surface_lights();
        scene.camera.near = 0.01;
        scene.camera.eye = {0, 1, 6};
        scene.camera.look_at = {0, 1, 0};
        const ImageRgb image = render_scene(scene, 16, bidirectional(2, Integrator::kVcm)).radiance;
        scene.camera.look_at = {0, 1, -6000};
        CHECK(bitwise_equal(image, render_scene(scene, 16, bidirectional(2, Integrator::kVcm)).radiance));
    }

    TEST_CASE("what it does not support is refused") {
        const Scene plain = under_delta_lights();
        PathTracerSettings settings = bidirectional(4);
        settings.adaptive = true;
        CHECK_THROWS_WITH_AS(check_bidirectional(plain, settings), doctest::Contains("--no-adaptive"), Error);
        settings = bidirectional(4);
        settings.filter = FilterKind::kBlackmanHarris;
        CHECK_THROWS_WITH_AS(check_bidirectional(plain, settings), doctest::Contains("expected box"), Error);
        settings = bidirectional(4, Integrator::kMetropolis);
        settings.sampler = SamplerKind::kCenter;
        CHECK_THROWS_WITH_AS(check_bidirectional(plain, settings), doctest::Contains("center"), Error);
        SceneBuilder builder = room();
        Dielectric wine;
        wine.absorption = Rgb(1.0f);
        builder.add(Sphere{{0, 1, 0}, 0.5f}, builder.material(wine));
        CHECK_THROWS_WITH_AS(check_bidirectional(builder.finish(), bidirectional(4)), doctest::Contains("absorbs"),
                             Error);
        for (const Integrator integrator :
             {Integrator::kBidirectional, Integrator::kVcm, Integrator::kPhotons, Integrator::kMetropolis})
            CHECK_THROWS_WITH_AS(radiance_function(integrator), doctest::Contains("whole images"), Error);
    }
}

TEST_SUITE("statistical") {
    // The mean weight of emitted rays is the flux of all lights. The bound is six standard errors of 20,000 independent
    // samples, exceeded by chance once in 5e8 times.
    TEST_CASE("lights emit their power") {
        for (const Scene& scene : {under_surface_lights(), under_delta_lights()}) {
            const PathTracerScene prepared = prepare(scene, PathTracerSettings{});
            const RenderPlan plan(prepared.data(), View{scene.camera, 8, 8}, PathTracerSettings{});
            const LightEmission emission(plan);
            double power = 0;
            for (const Light& light : scene.lights)
                power += static_cast<double>(light_power(light, length(scene.bounds.diagonal()) / 2));
            Sampler sampler(SamplerKind::kIndependent, 7, 1);
            constexpr int kRays = 20000;
            double sum = 0, squares = 0;
            for (std::uint32_t i = 0; i < kRays; ++i) {
                sampler.start(0, 0, i);
                const auto u = sampler.get_block();
                const auto ray = emission.sample({u[4], {u[0], u[1]}, {u[2], u[3]}}, 0);
                const double weight = ray ? static_cast<double>(average(ray->weight)) : 0;
                sum += weight;
                squares += sqr(weight);
            }
            const double mean = sum / kRays, error = std::sqrt(std::max(squares / kRays - sqr(mean), 0.0) / kRays);
            CHECK(std::abs(mean - power) < 6 * error + 1e-5 * power);
        }
    }

    TEST_CASE("the image converges to the path tracer's") {
        const std::pair<std::string, Scene> scenes[] = {
            {"surface lights", under_surface_lights()},   {"delta lights", under_delta_lights()},
            {"image environment", under_an_image()},      {"glass in motion", glass_in_motion()},
            {"coarse smooth ball", coarse_smooth_ball()}, {"light in a floor", light_in_a_floor()},
            {"orthographic", seen_in_parallel()}};
        for (const auto& named : scenes)
            for (const int depth : {1, 2, 5}) {
                CAPTURE(named.first);
                check_converges(named.second, depth, {Integrator::kBidirectional, 16, 512, 256, 0.002}, 0);
            }
    }

    // Photons of another time miss a ball that has moved on, and the more so the smaller the radius is. The tolerance
    // is that of the last test.
    TEST_CASE("merging converges to the path tracer's image of what moves fast") {
        check_converges(fast_ball(), 2, {Integrator::kVcm, 48, 128, 32, 0.004}, 0.005);
    }

    // All lights send photons here, or only some. The tolerance is 1 % for light that is blurred over the edges of
    // surfaces: the radius is 1/16 of the image. Direct light is not blurred.
    TEST_CASE("photon mapping converges to the path tracer's image") {
        const std::pair<std::string, Scene> scenes[] = {{"surface lights", under_surface_lights()},
                                                        {"delta lights", under_delta_lights()},
                                                        {"image environment", under_an_image()},
                                                        {"fast ball", fast_ball()},
                                                        {"partly without photons", partly_without_photons()}};
        for (const auto& named : scenes)
            for (const int depth : {1, 5}) {
                CAPTURE(named.first);
                const double blur = depth == 1 ? 0 : 0.01;
                check_converges(named.second, depth, {Integrator::kPhotons, 24, 256, 128, 0.004}, blur);
            }
    }

    // The mirror sends even light to the floor. Where the disk around a point reaches beyond the floor's edge, it finds
    // no photons there, and so much light is missing. Let (x, z) be uniform in a disk of radius r. A floor of sides 2
    // holds both a point and the point displaced by (x, z) with probability (1 - |x|/2)(1 - |z|/2), whose mean is
    // 1 - 4r/3π + r²/8π. The radius of sample i is that of the first times (i + 1)^(-1/8). The bound is five standard
    // errors over at least 20 seeds, which is exceeded by chance once in 12,000 times.
    TEST_CASE("the bias of photon mapping shrinks as theory says") {
        constexpr int kSize = 16;
        const double first_radius = 1.5 * 2 / kSize;
        for (const int samples : {1, 16, 256}) {
            PathTracerSettings settings = bidirectional(samples, Integrator::kPhotons);
            double inside = 0;
            for (int i = 0; i < samples; ++i) {
                const double r = first_radius * std::pow(i + 1.0, -0.125);
                inside += (1 - 4 * r / (3 * kPiDouble) + r * r / (8 * kPiDouble)) / samples;
            }
            const Estimate photons = estimate(floor_beside_a_mirror(), kSize, settings, 5120 / samples);
            CAPTURE(samples);
            CAPTURE(inside);
            CAPTURE(photons.mean);
            CAPTURE(photons.error);
            CHECK(std::abs(photons.mean / static_cast<double>(kSunRadiance) - (1 + inside)) <
                  5 * photons.error / static_cast<double>(kSunRadiance));
            CHECK(photons.error < 0.0015);
        }
    }

    // Merging blurs light over a radius, so that walls near edges and contacts are a little off: 0.5 % is allowed for
    // that.
    TEST_CASE("merging converges to the path tracer's image, also where it alone finds the light") {
        for (const Scene& scene : {under_surface_lights(), under_delta_lights(), glass_in_motion()})
            for (const int depth : {2, 5})
                check_converges(scene, depth, {Integrator::kVcm, 16, 512, 128, 0.004}, 0.005);
    }
}

// These tests compare bidirectional path tracing with the path tracer: both must converge to the same image, whatever
// emits, scatters and moves. Its parts are checked against closed forms.
#include "common/image/bitwise_equal.h"
#include "common/system/error.h"
#include "raytrace/bidirectional/bidirectional_pass.h"
#include "raytrace/bidirectional/camera_projection.h"
#include "raytrace/bidirectional/light_emission.h"
#include "raytrace/bidirectional/photon_map.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
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

            settings.film = std::filesystem::temp_directory_path() / "duet_bidirectional_test.exr";
            std::filesystem::remove(settings.film);
            for (const int samples : {1, 4, 6}) {
                settings.samples_per_pixel = samples;
                const ImageRgb image = render_scene(scene, 80, settings).radiance;
                CHECK(bitwise_equal(one, image) == (samples == 6));
            }
            std::filesystem::remove(settings.film);
        }
    }

    // Photons lie in clusters, on cell boundaries, at the same place, and far from the origin.
    TEST_CASE("the photon map finds each photon within the radius once, whatever the number of threads") {
        for (const float scale : {1e-6f, 1.0f, 1e6f})
            for (const int count : {0, 1, 5000}) {
                std::vector<Photon> photons;
                Sampler sampler(SamplerKind::kIndependent, 5, 1);
                for (int i = 0; i < count; ++i) {
                    sampler.start(0, 0, static_cast<std::uint32_t>(i));
                    const auto u = sampler.get_block();
                    Vec3 p = Vec3(u[0], u[1], u[2]) * scale;
                    if (i % 3 == 0) p = Vec3(std::floor(4 * u[0]), std::floor(4 * u[1]), 0) * (0.25f * scale);
                    if (i % 7 == 0) p = p - Vec3(scale, 0, scale);
                    photons.push_back({p, {}, Rgb(), {}, i});
                }
                const float radius = 0.05f * scale;
                const PhotonMap one(photons, radius, 1), three(photons, radius, 3);
                for (int i = 0; i < 200; ++i) {
                    sampler.start(1, 0, static_cast<std::uint32_t>(i));
                    const auto u = sampler.get_block();
                    const Vec3 p = i % 2 == 0 && count > 0 ? photons[static_cast<std::size_t>(i % count)].p
                                                           : (Vec3(u[0], u[1], u[2]) * 2.0f - Vec3(1, 1, 1)) * scale;
                    std::vector<int> found, found_by_three, expected;
                    one.for_each_near(p, [&](const Photon& photon) { found.push_back(photon.depth); });
                    three.for_each_near(p, [&](const Photon& photon) { found_by_three.push_back(photon.depth); });
                    for (const Photon& photon : photons)
                        if (length_squared(photon.p - p) <= sqr(radius)) expected.push_back(photon.depth);
                    CHECK(found == found_by_three);
                    std::sort(found.begin(), found.end());
                    CHECK(found == expected);
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

    // The pixel density is the inverse of the area, across the ray, that the rays of a small square of the image cover.
    TEST_CASE("a point is seen by the pixel whose ray hits it, at the density of those rays") {
        View view{Camera{}, 80, 60};
        view.camera.eye = {1, 2, 5};
        view.camera.look_at = {0, 0.5, 0};
        view.camera.aperture_radius = 0.2;
        for (const auto projection : {Camera::Projection::kPerspective, Camera::Projection::kOrthographic}) {
            view.camera.projection = projection;
            const Pinhole pinhole = CameraModel(view).pinhole({0.9, 0.3});
            const auto at = [&](double x, double y, double t) {
                const Rayd ray = pinhole.ray({x, y});
                return ray.origin + ray.direction * t;
            };
            const double x = 12.3, y = 51.7, step = 1e-4;
            const Vec3d p = at(x, y, 4), direction = pinhole.ray({x, y}).direction;
            const auto seen = seen_through(pinhole, p);
            REQUIRE(seen.has_value());
            CHECK(seen->pixel.x == doctest::Approx(x));
            CHECK(seen->pixel.y == doctest::Approx(y));
            CHECK(length(seen->to_camera + direction) < 1e-9);
            CHECK(seen->distance == doctest::Approx(4 - pinhole.ray({x, y}).t_min));
            const Vec3d dx = (at(x + step, y, 4) - p) / step, dy = (at(x, y + step, 4) - p) / step;
            CHECK(seen->pixel_density == doctest::Approx(1 / std::abs(dot(cross(dx, dy), direction))).epsilon(1e-3));
            CHECK(!seen_through(pinhole, pinhole.origin + pinhole.forward * (pinhole.near * 0.9)).has_value());
        }
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

    // The bound is six standard errors of the difference over ten seeds each, which is exceeded by chance once in
    // 90,000 times.
    TEST_CASE("the image converges to the path tracer's") {
        const std::pair<std::string, Scene> scenes[] = {
            {"surface lights", under_surface_lights()},   {"delta lights", under_delta_lights()},
            {"image environment", under_an_image()},      {"glass in motion", glass_in_motion()},
            {"coarse smooth ball", coarse_smooth_ball()}, {"light in a floor", light_in_a_floor()},
            {"orthographic", seen_in_parallel()}};
        for (const auto& named : scenes)
            for (const int depth : {1, 2, 5}) {
                PathTracerSettings settings;
                settings.max_depth = depth;
                settings.samples_per_pixel = 512;
                const Estimate path = estimate(named.second, 16, settings);
                settings.integrator = Integrator::kBidirectional;
                settings.samples_per_pixel = 256;
                const Estimate joined = estimate(named.second, 16, settings);
                CAPTURE(named.first);
                CAPTURE(depth);
                CAPTURE(path.mean);
                CAPTURE(path.error);
                CAPTURE(joined.mean);
                CAPTURE(joined.error);
                CHECK(deviations(path, joined) < 6);
                CHECK(joined.error < 0.002 * joined.mean);
            }
    }

    // Photons of another time miss a ball that has moved on, and the more so the smaller the radius is. The tolerance
    // is that of the next test.
    TEST_CASE("merging converges to the path tracer's image of what moves fast") {
        PathTracerSettings settings;
        settings.max_depth = 2;
        settings.samples_per_pixel = 128;
        const Estimate path = estimate(fast_ball(), 48, settings);
        settings.integrator = Integrator::kVcm;
        settings.samples_per_pixel = 32;
        const Estimate merged = estimate(fast_ball(), 48, settings);
        CAPTURE(path.mean);
        CAPTURE(path.error);
        CAPTURE(merged.mean);
        CAPTURE(merged.error);
        CHECK(std::abs(path.mean - merged.mean) < 6 * std::hypot(path.error, merged.error) + 0.005 * path.mean);
        CHECK(merged.error < 0.004 * merged.mean);
    }

    // All lights send photons here, or only some. The bound is six standard errors, and 1 % for light that is blurred
    // over the edges of surfaces. Direct light is not blurred.
    TEST_CASE("photon mapping converges to the path tracer's image") {
        const std::pair<std::string, Scene> scenes[] = {{"surface lights", under_surface_lights()},
                                                        {"delta lights", under_delta_lights()},
                                                        {"image environment", under_an_image()},
                                                        {"fast ball", fast_ball()},
                                                        {"partly without photons", partly_without_photons()}};
        for (const auto& named : scenes)
            for (const int depth : {1, 5}) {
                PathTracerSettings settings;
                settings.max_depth = depth;
                settings.samples_per_pixel = 256;
                const Estimate path = estimate(named.second, 24, settings);
                settings.integrator = Integrator::kPhotons;
                settings.samples_per_pixel = 128;
                const Estimate photons = estimate(named.second, 24, settings);
                CAPTURE(named.first);
                CAPTURE(depth);
                CAPTURE(path.mean);
                CAPTURE(photons.mean);
                CAPTURE(photons.error);
                const double blur = depth == 1 ? 0 : 0.01 * path.mean; // the radius is 1/16 of the image
                CHECK(std::abs(path.mean - photons.mean) < 6 * std::hypot(path.error, photons.error) + blur);
                CHECK(photons.error < 0.004 * photons.mean);
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
    // that, and six standard errors.
    TEST_CASE("merging converges to the path tracer's image, also where it alone finds the light") {
        for (const Scene& scene : {under_surface_lights(), under_delta_lights(), glass_in_motion()})
            for (const int depth : {2, 5}) {
                PathTracerSettings settings;
                settings.max_depth = depth;
                settings.samples_per_pixel = 512;
                const Estimate path = estimate(scene, 16, settings);
                settings.integrator = Integrator::kVcm;
                settings.samples_per_pixel = 128;
                const Estimate merged = estimate(scene, 16, settings);
                CAPTURE(depth);
                CAPTURE(path.mean);
                CAPTURE(merged.mean);
                CAPTURE(merged.error);
                CHECK(std::abs(path.mean - merged.mean) < 6 * std::hypot(path.error, merged.error) + 0.005 * path.mean);
                CHECK(merged.error < 0.004 * merged.mean);
            }
    }
}

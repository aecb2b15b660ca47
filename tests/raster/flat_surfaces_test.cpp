// These tests check the prefiltered image of flat surfaces and sky that replaces occluded surfaces in reflections.
#include "tests/raster/scenes.h"

#include "raster/screen_space/flat_surfaces.h"
#include "raster/screen_space/ray_march.h"
#include "raster/screen_space/screen_space_tracer.h"
#include "raster/shading/light_components.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::test;

TEST_SUITE("unit") {

    // A ray that hits an occluded surface samples a blurred image. That image must contain the floor and not the
    // objects on it.
    TEST_CASE("what is hidden is seen as the flat surfaces and the sky about it: no ball is flat, however fine the picture") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-4, 0, 4), Vec3(8, 0, 0), Vec3(0, 0, -6)}}}, Mat4(), Diffuse{{Rgb(0, 1, 0)}});
        add(scene, Sphere{Vec3(0, 0.6f, 0.5f), 0.6f}, Mat4(), Diffuse{{Rgb(1, 0, 0)}});
        // The small metal sphere makes the renderer compute reflections.
        add(scene, Sphere{Vec3(-2, 0.3f, 0), 0.3f}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        for (const int height : {60, 240, 720}) {
            const View view{look({0, 1.5, 4}, {0, 0.6, 0}, 50), height * 4 / 3, height};
            const auto gbuffer = raster::make_screen_gbuffer(raster::prepare(scene, plain()), view, plain());
            const raster::RadiancePyramid& flat = gbuffer->flat_radiance();
            CAPTURE(height);
            REQUIRE_FALSE(flat.empty());
            for (const float wide : {1.0f, 4.0f, 30.0f})
                for (const float part : {0.1f, 0.3f, 0.5f, 0.7f}) {
                    const Rgb seen =
                        flat.at(part * static_cast<float>(view.width), 0.55f * static_cast<float>(height), wide);
                    CHECK(seen.g > 0.2f);
                    // Red minus blue is the sphere's contribution: the sky has equal red and blue, the floor neither.
                    CHECK(seen.r - seen.b < 0.01f);
                }
        }
    }

    TEST_CASE("seen from infinitely far the same is flat wherever the eye stands: a floor, and no ball") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-4, 0, 4), Vec3(8, 0, 0), Vec3(0, 0, -8)}}});
        add(scene, Sphere{Vec3(0, 0.6f, 0), 0.6f});
        // The small metal sphere makes the renderer compute reflections.
        add(scene, Sphere{Vec3(-2, 0.3f, 0), 0.3f}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        for (const double height : {1.3, 3.0, 300.0}) {
            Camera camera = look({0, height, 0}, {0, 0, 0});
            camera.projection = Camera::Projection::kOrthographic;
            camera.up = {0, 0, -1};
            camera.height = 4;
            const View view{camera, 200, 200};
            const auto gbuffer = raster::make_screen_gbuffer(raster::prepare(scene, plain()), view, plain());
            CAPTURE(height);
            CHECK(raster::is_flat(*gbuffer, 160, 160));
            CHECK_FALSE(raster::is_flat(*gbuffer, 100, 100));
        }
    }

    TEST_CASE("a mirror on which things stand is not what they hide from it") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-8, 0, 4), Vec3(16, 0, 0), Vec3(0, 0, -6)}}}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        add(scene, QuadList{{{Vec3(-8, 0, -2), Vec3(16, 0, 0), Vec3(0, 8, 0)}}}, Mat4(), Diffuse{{Rgb(0, 1, 0)}});
        add(scene, Sphere{Vec3(0, 0.6f, 0.5f), 0.6f}, Mat4(), Diffuse{{Rgb(1, 0, 0)}});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const View view{look({0, 1.5, 4}, {0, 0.6, 0}, 50), 320, 240};
        const auto gbuffer = raster::make_screen_gbuffer(raster::prepare(scene, plain()), view, plain());
        for (const float y : {60.0f, 140.0f, 220.0f}) { // wall, sphere, floor
            const Rgb seen = gbuffer->flat_radiance().at(160, y, 4);
            CHECK(seen.g > 0.2f);
            CHECK(seen.r < 0.01f);
        }
    }

    TEST_CASE("a picture known in part: what is known stays, the rest is filled from what is about it; of nothing, nothing") {
        ImageRgb picture(37, 21, Rgb(5.0f));
        ImageFloat known(37, 21);
        CHECK(raster::RadiancePyramid(picture, known, 0).empty());
        for (int y = 0; y < 21; ++y)
            for (int x = 0; x < 37; ++x)
                if (x < 6 || x > 30) known(x, y) = 1, picture(x, y) = Rgb(x < 6 ? 1.0f : 2.0f);
        const raster::RadiancePyramid filled(picture, known, 1);
        CHECK(filled.at(3, 10, 1).g == doctest::Approx(1));
        CHECK(filled.at(34, 10, 1).g == doctest::Approx(2));
        for (float x = 6; x < 31; ++x)
            for (const float wide : {1.0f, 3.0f, 9.0f}) {
                CHECK(filled.at(x, 10, wide).g > 0.99f);
                CHECK(filled.at(x, 10, wide).g < 2.01f);
            }
        CHECK(filled.at(10, 10, 1).g < filled.at(26, 10, 1).g);
    }

    TEST_CASE("a pyramid of what is known is the same by any number of threads") {
        constexpr int kWidth = 320, kHeight = 203;
        ImageRgb picture(kWidth, kHeight);
        ImageFloat known(kWidth, kHeight);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> uniform(0, 1);
        for (Rgb& c : picture.pixels()) c = Rgb(uniform(random), uniform(random), uniform(random));
        for (float& k : known.pixels()) k = uniform(random) < 0.2f ? 1.0f : 0.0f;
        const raster::RadiancePyramid by_one(picture, known, 1), by_two(picture, known, 2), by_seven(picture, known, 7);
        for (const float wide : {1.0f, 2.0f, 8.0f, 64.0f})
            for (float y = 0; y < kHeight; y += 3)
                for (float x = 0; x < kWidth; x += 3) {
                    CHECK(by_two.at(x, y, wide) == by_one.at(x, y, wide));
                    CHECK(by_seven.at(x, y, wide) == by_one.at(x, y, wide));
                }
    }

    TEST_CASE("what is hidden of a floor is of both sides about it: more of the nearer one, seen where it lies") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-6, 0, 4), Vec3(6, 0, 0), Vec3(0, 0, -8)}}}, Mat4(), Diffuse{{Rgb(0, 1, 0)}});
        add(scene, QuadList{{{Vec3(0, 0, 4), Vec3(6, 0, 0), Vec3(0, 0, -8)}}}, Mat4(), Diffuse{{Rgb(0, 0, 1)}});
        add(scene, Sphere{Vec3(0, 0.6f, 1), 0.6f}, Mat4(), Diffuse{{Rgb(1, 0, 0)}});
        // The small metal sphere makes the renderer compute reflections.
        add(scene, Sphere{Vec3(-2, 0.3f, -3), 0.3f}, Mat4(), Metal{{Rgb(1.0f)}, 0});
        scene.environment = ConstantEnvironment{Rgb(1.0f)};
        finish_scene(scene);
        const raster::RasterScene prepared = raster::prepare(scene, plain());
        const auto gbuffer =
            raster::make_screen_gbuffer(prepared, {look({0, 1.5, 4}, {0, 0.6, 0}, 50), 160, 120}, plain());
        const raster::ScreenSpaceTracer around(prepared.data(), plain(), {*gbuffer});
        const Box3 bounds{gbuffer->to_eye_relative(scene.bounds.low - Vec3(0.1f, 0.1f, 0.1f)),
                          gbuffer->to_eye_relative(scene.bounds.high)};
        const Vec3 from(-2.5f, 0.8f, -0.5f);
        for (const float x : {-0.6f, -0.3f, 0.3f, 0.6f}) {
            const Vec3 to(x, 0, -0.5f);
            const Vec3 p = gbuffer->to_eye_relative(from), n(1, 0, 0), direction = normalize(to - from);
            const auto hit = raster::march_ray({*gbuffer}, bounds, {p, n, direction, false});
            CAPTURE(x);
            REQUIRE(hit);
            CHECK(hit->hidden);
            CHECK(hit->distance == doctest::Approx(length(to - from)).epsilon(0.02));
            const Vec3 place = gbuffer->project(gbuffer->to_eye_relative(to));
            CHECK(std::abs(hit->x - place.x) < 1);
            CHECK(std::abs(hit->y - place.y) < 1);
            const Rgb seen =
                around.incoming_radiance({.p = p, .n = n, .direction = direction, .from_visible_surface = false});
            CHECK(seen.r < 0.2f); // from the sky
            CHECK(std::abs(seen.g - seen.b) > 0.02f);
            CHECK((seen.g > seen.b) == (x < 0));
        }
    }
}

// Lesson raster-10 and the library: the same directions, and the same occlusion next to a wall.
#include "common/sampling/warp.h"
#include "raster/lessons/10-ambient-occlusion/occlusion.h"
#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

#include <array>

using namespace duet;

namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr double kFov = 50;

/// A floor of 40 m, and a wall of height 1 on the plane z = 0; a camera in front of it.
lesson::GBuffer draw_lesson(bool wall) {
    lesson::Mesh world;
    const auto add = [&world](Vec3 corner, Vec3 u, Vec3 v) {
        for (const Vec2 q : {Vec2{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
            world.push_back({corner + u * q.x + v * q.y, normalize(cross(u, v)), {}});
    };
    add({-20, 0, 20}, {40, 0, 0}, {0, 0, -40});
    if (wall) add({-20, 0, 0}, {40, 0, 0}, {0, 1, 0});
    const Mat4 camera =
        lesson::perspective(static_cast<float>(radians(kFov)), static_cast<float>(kWidth) / kHeight, 0.1f, 60) *
        lesson::look_at({0, 3, 4}, {0, 0.3f, 0.7f}, {0, 1, 0});
    return lesson::draw_gbuffer(world, camera, kWidth, kHeight);
}

/// The same by the library: what a white floor shows under a sky of radiance 1.
ImageRgb draw_library(float radius) {
    Scene scene;
    test::add(scene, QuadList{{{Vec3(-20, 0, 20), Vec3(40, 0, 0), Vec3(0, 0, -40)}}}, Mat4(), Diffuse{{Rgb(1.0f)}});
    test::add(scene, QuadList{{{Vec3(-20, 0, 0), Vec3(40, 0, 0), Vec3(0, 1, 0)}}}, Mat4(), Diffuse{{Rgb(0.0f)}});
    scene.environment = ConstantEnvironment{Rgb(1.0f)};
    finish_scene(scene);
    raster::RasterSettings settings;
    settings.indirect_light = false, settings.occlusion_radius = static_cast<double>(radius),
    settings.samples_per_pixel = 16;
    return test::render(scene, View{test::look({0, 3, 4}, {0, 0.3, 0.7}, kFov), kWidth, kHeight}, settings).radiance;
}

/// The fraction of the cosine-weighted directions over the floor at a distance z from the wall that meet it within the
/// radius: the midpoint rule over Malley's disk.
double hidden_by_wall(double z, double radius) {
    constexpr int kSide = 400;
    double hidden = 0, all = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const double x = 2 * (i % kSide + 0.5) / kSide - 1, back = 2 * (i / kSide + 0.5) / kSide - 1,
                     squared = x * x + back * back;
        if (squared >= 1) continue;
        ++all;
        if (back >= 0) continue;
        const double t = z / -back; // where the ray meets the plane of the wall
        hidden += t < radius && t * std::sqrt(1 - squared) < 1;
    }
    return hidden / all;
}

} // namespace

TEST_SUITE("lesson") {

    // Both have density cos θ / π: then cos² θ is uniform in [0, 1], and so is the angle around n. 4096 directions of
    // the spiral fill each of 16 × 8 equal cells 32 times but a few. The library's grid of 256 × 256 fills it 512 times
    // but for the points along the cell's rim: a cell of 16 × 32 points has 96 of them.
    TEST_CASE("raster-10: the lesson's directions and the library's fill the same cells of the hemisphere") {
        constexpr int kCount = 4096;
        const Vec3 n{0, 0, 1};
        std::array<std::array<int, 128>, 2> counts{};
        const auto add = [&](std::size_t which, Vec3 d) {
            REQUIRE(std::abs(length(d) - 1) < 1e-5f);
            REQUIRE(d.z > 0);
            const int ring = min(static_cast<int>(d.z * d.z * 16), 15);
            const float turn = std::atan2(d.y, d.x) / (2 * kPi) + 0.5f;
            ++counts[which][static_cast<std::size_t>(ring * 8 + min(static_cast<int>(turn * 8), 7))];
        };
        for (int i = 0; i < kCount; ++i) add(0, lesson::hemisphere_direction(n, i, kCount, 0.3f));
        for (int i = 0; i < 256 * 256; ++i) {
            const float u = (static_cast<float>(i % 256) + 0.5f) / 256;
            add(1, cosine_hemisphere(Vec2{u, (static_cast<float>(i / 256) + 0.5f) / 256}));
        }
        for (std::size_t cell = 0; cell < 128; ++cell) {
            CAPTURE(cell);
            CHECK(std::abs(counts[0][cell] - kCount / 128) <= 4);
            CHECK(std::abs(counts[1][cell] - 256 * 256 / 128) <= 96);
        }
    }

    TEST_CASE("raster-10: next to a wall, lesson, library and formula agree; a floor alone is white") {
        for (const Rgb& c : lesson::sky_light(draw_lesson(false), {.bias = 0.05f})) REQUIRE(c.r == 1);
        // The lesson's four points a direction suffice for a radius that is small beside the wall. In the library,
        // horizons farther than half the radius count less, so it gets a large one.
        const lesson::GBuffer seen = draw_lesson(true);
        const ImageRgb mine = lesson::sky_light(seen, {.directions = 32, .radius = 0.6f, .bias = 0.02f, .range = 0.6f});
        const ImageRgb library = draw_library(10);
        int rows = 0;
        for (int y = 0; y < kHeight; ++y) {
            const double z = static_cast<double>(seen.p(kWidth / 2, y).z);
            if (seen.n(kWidth / 2, y).y < 0.9f || z < 0.1 || z > 0.6) continue;
            double by_lesson = 0, by_library = 0;
            for (int x = 60; x < 100; ++x) {
                by_lesson += (1 - static_cast<double>(mine(x, y).r)) / 40;
                by_library += (1 - static_cast<double>(library(x, y).g)) / 40;
            }
            CAPTURE(z);
            // The farthest point of a direction is at 0.6 to 1 times the radius: the lesson finds too little, never too
            // much.
            const double near_wall = hidden_by_wall(z, 0.6);
            CHECK((by_lesson < near_wall + 0.01 && by_lesson > near_wall - 0.1));
            CHECK(std::abs(by_library - hidden_by_wall(z, 1e9)) < 0.066); // measured: 0.0644
            ++rows;
        }
        CHECK(rows > 8);
    }
}

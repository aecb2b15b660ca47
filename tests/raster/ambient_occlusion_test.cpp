// The environment's occlusion against form factors.
#include "tests/raster/scenes.h"

#include "raster/ambient_occlusion.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

/// What a white floor in a constant environment of radiance 1 shows is the part of it that it sees.
ImageRgb visible(const Scene& scene, const View& view, raster::AmbientOcclusion kind, int spp = 4, int threads = 0) {
    raster::Settings settings;
    settings.ambient_occlusion = kind;
    settings.occlusion_radius = kind == raster::AmbientOcclusion::kSsao ? 2 : 10;
    settings.samples_per_pixel = spp;
    settings.threads = threads;
    return render(scene, view, settings).radiance;
}

Scene white_scene() {
    Scene scene;
    add(scene, QuadList{{{Vec3(-20, 0, 20), Vec3(40, 0, 0), Vec3(0, 0, -40)}}}, Mat4(), Diffuse{{Rgb(1.0f)}});
    scene.environment = ConstantEnvironment{Rgb(1.0f)};
    return scene;
}

constexpr raster::AmbientOcclusion kBoth[] = {raster::AmbientOcclusion::kSsao, raster::AmbientOcclusion::kGtao};

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("nothing hides the environment from a plane and from the outside of a sphere, however they are seen") {
        for (const raster::AmbientOcclusion kind : kBoth)
            for (const Vec3d eye : {Vec3d(0, 3, 0.5), Vec3d(0, 0.3, 3), Vec3d(0.1, 0.05, 2)}) {
                Scene floor = white_scene();
                finish_scene(floor);
                for (const Rgb c : visible(floor, {look(eye, {0, 0, 0}), 48, 32}, kind))
                    CHECK(c.g == doctest::Approx(1).epsilon(1e-5));
                Scene ball;
                add(ball, Sphere{Vec3(0, 0, 0), 0.5f}, Mat4(), Diffuse{{Rgb(1.0f)}});
                ball.environment = ConstantEnvironment{Rgb(1.0f)};
                finish_scene(ball);
                for (const Rgb c : visible(ball, {look(eye, {0, 0, 0}), 48, 32}, kind))
                    CHECK(c.g == doctest::Approx(1).epsilon(1e-5));
            }
    }

    // A wall of height 1 hides ½ (1 − x/√(x² + 1)) of the sky at a distance x.
    TEST_CASE("at the foot of a long wall: the form factor of the strip, to 0.05 by horizons") {
        Scene scene = white_scene();
        add(scene, QuadList{{{Vec3(-20, 0, 0), Vec3(40, 0, 0), Vec3(0, 1, 0)}}}, Mat4(), Diffuse{{Rgb(0.0f)}});
        finish_scene(scene);
        const View view{look({0, 3, 4}, {0, 0.3, 0.7}, 50), 160, 120};
        const Pinhole pinhole = CameraModel(view).through();
        for (const raster::AmbientOcclusion kind : kBoth) {
            const ImageRgb found = visible(scene, view, kind, 16);
            int rows = 0;
            for (int y = 0; y < view.height; ++y) {
                const Rayd ray = pinhole.ray({80, y + 0.5});
                const double z = ray.at(-ray.origin.y / ray.direction.y).z;
                if (z < 0.1 || z > 2) continue;
                double mean = 0;
                for (int x = 60; x < 100; ++x) mean += static_cast<double>(found(x, y).g) / 40;
                const double hidden = (1 - z / std::sqrt(z * z + 1)) / 2;
                CAPTURE(z);
                if (kind == raster::AmbientOcclusion::kGtao)
                    CHECK(std::abs(1 - mean - hidden) < 0.05);
                else // points at one distance a direction miss what is nearer or farther: too little, never too much
                    CHECK((1 - mean < hidden + 0.02 && (z > 0.3 || 1 - mean > 0.25 * hidden)));
                ++rows;
            }
            CHECK(rows > 30);
        }
    }

    TEST_CASE("horizons converge to the form factor of the strip as steps grow: to 0.01 with 400") {
        Scene scene = white_scene();
        add(scene, QuadList{{{Vec3(-20, 0, 0), Vec3(40, 0, 0), Vec3(0, 1, 0)}}});
        finish_scene(scene);
        const View view{look({0, 3, 4}, {0, 0.3, 0.7}, 50), 640, 480};
        raster::Settings depths;
        depths.output = raster::Output::kNearness;
        const raster::Screen screen(CameraModel(view).through(), {}, render(scene, view, depths).nearness);
        for (const double z : {0.2, 0.7, 1.5}) {
            const Vec3 p = screen.relative(Vec3(Vec3d(0.01, 0, z)));
            double mean = 0;
            for (std::uint64_t key = 0; key < 100; ++key)
                mean += static_cast<double>(raster::horizon_occlusion(screen, {p, {0, 1, 0}, normalize(-p)}, 10, 4, 400, key)) / 100;
            CAPTURE(z);
            CHECK(std::abs(mean - (1 - (1 - z / std::sqrt(z * z + 1)) / 2)) < 0.01);
        }
    }

    TEST_CASE("the same bits for any number of threads, with motion and lens, too; unknown names are refused") {
        Scene scene = white_scene();
        add(scene, torus(24, 12), translation(Vec3(0, 0.5f, 0)));
        finish_scene(scene);
        View view{look({0, 3, 4}, {0, 0.3, 0.7}, 50), 80, 60};
        view.camera.aperture_radius = 0.1;
        for (const raster::AmbientOcclusion kind : kBoth)
            CHECK(visible(scene, view, kind, 4, 1).pixels() == visible(scene, view, kind, 4, 5).pixels());
        CHECK_THROWS_AS(raster::ambient_occlusion("hbao"), Error);
        CHECK(raster::ambient_occlusion("ssao") == raster::AmbientOcclusion::kSsao);
    }
}

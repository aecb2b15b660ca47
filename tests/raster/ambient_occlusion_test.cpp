// These tests compare the occlusion of the environment with form factors.
#include "tests/raster/path_traced.h"
#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

/// Returns the visible fraction of a constant environment of radiance 1, as the radiance of a white floor.
ImageRgb visible(const Scene& scene, const View& view, int spp = 4, int threads = 0) {
    raster::RasterSettings settings;
    settings.indirect_light = false;
    settings.occlusion_radius = 10;
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

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("nothing hides the environment from a plane and from the outside of a sphere, however they are seen") {
        for (const Vec3d eye : {Vec3d(0, 3, 0.5), Vec3d(0, 0.3, 3), Vec3d(0.1, 0.05, 2)}) {
            Scene floor = white_scene();
            finish_scene(floor);
            for (const Rgb c : visible(floor, {look(eye, {0, 0, 0}), 48, 32}))
                CHECK(c.g == doctest::Approx(1).epsilon(0.02));
            Scene ball;
            add(ball, Sphere{Vec3(0, 0, 0), 0.5f}, Mat4(), Diffuse{{Rgb(1.0f)}});
            ball.environment = ConstantEnvironment{Rgb(1.0f)};
            finish_scene(ball);
            for (const Rgb c : visible(ball, {look(eye, {0, 0, 0}), 48, 32}))
                CHECK(c.g == doctest::Approx(1).epsilon(0.02));
        }
    }

    // At distance x, a wall of height 1 hides ½ (1 − x/√(x² + 1)) of the sky.
    TEST_CASE("at the foot of a long wall: the form factor of the strip, to 0.066 by horizons") {
        Scene scene = white_scene();
        add(scene, QuadList{{{Vec3(-20, 0, 0), Vec3(40, 0, 0), Vec3(0, 1, 0)}}}, Mat4(), Diffuse{{Rgb(0.0f)}});
        finish_scene(scene);
        const View view{look({0, 3, 4}, {0, 0.3, 0.7}, 50), 160, 120};
        const Pinhole pinhole = CameraModel(view).pinhole();
        {
            const ImageRgb found = visible(scene, view, 16);
            int rows = 0;
            for (int y = 0; y < view.height; ++y) {
                const Rayd ray = pinhole.ray({80, y + 0.5});
                const double z = ray.at(-ray.origin.y / ray.direction.y).z;
                if (z < 0.1 || z > 2) continue;
                double mean = 0;
                for (int x = 60; x < 100; ++x) mean += static_cast<double>(found(x, y).g) / 40;
                const double hidden = (1 - z / std::sqrt(z * z + 1)) / 2;
                CAPTURE(z);
                CHECK(std::abs(1 - mean - hidden) < 0.066); // measured: 0.0643 at the foot, by averaging over 14 pixels
                ++rows;
            }
            CHECK(rows > 30);
        }
    }

    TEST_CASE("no grain: along a wall, where all is the same, pixels differ by less than 0.25 % from the next one") {
        Scene scene = white_scene();
        add(scene, QuadList{{{Vec3(-20, 0, 0), Vec3(40, 0, 0), Vec3(0, 1, 0)}}}, Mat4(), Diffuse{{Rgb(0.0f)}});
        finish_scene(scene);
        const View view{look({0, 3, 4}, {0, 0.3, 0.7}, 50), 160, 120};
        {
            const ImageRgb found = visible(scene, view, 1);
            double sum = 0, worst = 0;
            for (int y = 60; y < 116; ++y)
                for (int x = 40; x < 120; ++x) {
                    const double step =
                        std::abs(static_cast<double>(found(x, y).g) - static_cast<double>(found(x + 1, y).g));
                    sum += step / (56 * 80), worst = std::max(worst, step);
                }
            CAPTURE(worst);
            CHECK(sum < 0.0006);
            CHECK(worst < 0.0025);
        }
    }

    // An occluder that hides a little of the sky from many points is hit by few samples of each. If such hits appear
    // and disappear between pixels, the ground shows banding. Second differences over two pixels are 0 where
    // occlusion changes linearly.
    TEST_CASE("no steps: around a thin pole shade changes evenly, to 0.004 from pixel to pixel; nor from a size of "
              "image to the next") {
        Scene scene = white_scene();
        add(scene, QuadList{box_quads(Vec3(-0.1f, 0, -0.1f), Vec3(0.1f, 1.5f, 0.1f))}, Mat4(), Diffuse{{Rgb(0.0f)}});
        finish_scene(scene);
        double before = 0;
        for (const int height : {480, 400, 399, 320}) {
            const View view{look({0, 3, 4}, {0, 0.3, 0.7}, 50), height * 4 / 3, height};
            const ImageRgb found = visible(scene, view, 1);
            const int left = height * 380 / 480, right = height * 600 / 480, top = height * 200 / 480,
                      bottom = height * 460 / 480;
            double sum = 0, worst = 0;
            for (int y = top; y < bottom; ++y)
                for (int x = left; x < right; ++x) {
                    const double bend =
                        std::abs(static_cast<double>(found(x - 2, y).g) - 2 * static_cast<double>(found(x, y).g) +
                                 static_cast<double>(found(x + 2, y).g));
                    sum += bend / ((bottom - top) * (right - left)), worst = std::max(worst, bend);
                }
            const double larger = sqr(480.0 / height); // factor for the curvature over two pixels
            CAPTURE(height);
            CHECK(sum < 0.0035 * std::sqrt(larger)); // measured: 0.0029
            CHECK(worst < 0.11);                     // measured: 0.095, at the pole
            if (height == 399) CHECK(std::abs(sum - before) < 0.1 * before);
            before = sum;
        }
    }

    // Lines repeat every eight pixels. Second differences over half of that are largest where this shows.
    TEST_CASE("no blocks beside a ball: shade changes evenly over eight pixels, to 0.004 in the mean") {
        Scene scene = white_scene();
        add(scene, Sphere{Vec3(0, 0.5f, 0), 0.5f}, Mat4(), Diffuse{{Rgb(0.0f)}});
        finish_scene(scene);
        const View view{look({0, 1.5, 5}, {0, 0.3, 0}, 30), 960, 720};
        const ImageRgb found = visible(scene, view, 1);
        double sum = 0;
        int count = 0;
        for (int y = 200; y < view.height; ++y)
            for (int x = 4; x + 4 < view.width; ++x) {
                const auto at = [&](int dx) { return static_cast<double>(found(x + dx, y).g); };
                if (at(-4) == 0 || at(0) == 0 || at(4) == 0 || at(0) > 0.97) continue; // the ball is black
                sum += std::abs(at(-4) - 2 * at(0) + at(4)), ++count;
            }
        CHECK(count > 10000);
        CHECK(sum / count < 0.004); // measured: 0.0030
    }

    TEST_CASE("small images show what large ones do: about a thin pole and a low slab, to what four times four of "
              "their pixels see") {
        const auto rms = [](QuadList box) {
            Scene scene = white_scene();
            add(scene, std::move(box), Mat4(), Diffuse{{Rgb(0.0f)}});
            finish_scene(scene);
            const View small{look({0, 3, 4}, {0, 0.3, 0.7}, 50), 160, 120}, large{small.camera, 640, 480};
            const ImageRgb found = visible(scene, small, 1);
            const ImageRgb full = visible(scene, large, 1);
            double squares = 0;
            int shaded = 0;
            for (int y = 0; y < small.height; ++y)
                for (int x = 0; x < small.width; ++x) {
                    double mean = 0, least = static_cast<double>(found(x, y).g); // black: not the floor
                    for (int k = 0; k < 16; ++k) {
                        const auto fine = static_cast<double>(full(4 * x + k % 4, 4 * y + k / 4).g);
                        mean += fine / 16, least = std::min(least, fine);
                    }
                    if (least == 0 || mean > 0.99) continue;
                    squares += sqr(static_cast<double>(found(x, y).g) - mean), ++shaded;
                }
            CHECK(shaded > 500);
            return std::sqrt(squares / shaded);
        };
        CHECK(rms(box_quads(Vec3(-0.1f, 0, -0.1f), Vec3(0.1f, 1.5f, 0.1f))) < 0.03); // measured: 0.027
        CHECK(rms(box_quads(Vec3(-0.5f, 0, -0.5f), Vec3(0.5f, 0.1f, 0.5f))) < 0.07); // measured: 0.065
    }

    // The scene is a white wall over a black floor under a sky that is black below the horizon. The floor therefore
    // hides only black environment.
    TEST_CASE("what is hidden of a sky is what it would have given") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-20, 0, 20), Vec3(40, 0, 0), Vec3(0, 0, -40)}}}, Mat4(), Diffuse{{Rgb(0.0f)}});
        add(scene, QuadList{{{Vec3(-20, 0, 0), Vec3(40, 0, 0), Vec3(0, 3, 0)}}}, Mat4(), Diffuse{{Rgb(1.0f)}});
        scene.environment = SkyEnvironment{Rgb(0.0f), Rgb(1.0f)};
        finish_scene(scene);
        const View view{look({0, 8, 8}, {0, 0.5, 2}, 50), 96, 64}; // all of the floor near the wall
        const ImageRgb found = visible(scene, view, 4);
        const Pinhole pinhole = CameraModel(view).pinhole();
        int rows = 0;
        for (int y = 0; y < view.height; ++y) {
            const Rayd ray = pinhole.ray({48, y + 0.5});
            const double height = ray.at(-ray.origin.z / ray.direction.z).y;
            if (height < 0.1 || height > 1) continue;
            // The expected radiance is ½ ∫ (1 + w·y) cos dw / π over the upper half of the wall's hemisphere, where ∫
            // w·y cos dw is 2/3. Scaling the whole irradiance by the visible fraction would give 0.25.
            const double all = 0.5 * (0.5 + 2.0 / 3 / kPiDouble);
            CAPTURE(height);
            CHECK(std::abs(static_cast<double>(found(48, y).g) - all) < 0.06);
            ++rows;
        }
        CHECK(rows >= 4);
    }

    // Pixels without depth have a special distance, which must not affect their neighbors.
    TEST_CASE("pixels that see nothing spoil nothing: near a silhouette all is finite, wherever the near plane is") {
        for (const double size : {1.0, 100.0, 1e4}) {
            const float s = static_cast<float>(size);
            Scene scene;
            add(scene, Sphere{Vec3(0, 0, 0), s}, Mat4(), Diffuse{{Rgb(1.0f)}});
            add(scene, QuadList{box_quads(Vec3(-2 * s, -s, -s), Vec3(-0.5f * s, 0.5f * s, s))}, Mat4(),
                Diffuse{{Rgb(1.0f)}});
            scene.environment = SkyEnvironment{{1, 0.5f, 0.2f}, {0.1f, 0.3f, 1}};
            finish_scene(scene);
            View view{look(Vec3d(1, 2, 5) * size, {0, 0, 0}), 100, 75};
            const ImageRgb expected = visible(scene, view);
            view.camera.near = size;
            const ImageRgb found = visible(scene, view);
            CAPTURE(size);
            int invalid = 0;
            double sum = 0;
            for (std::size_t i = 0; i < found.size(); ++i)
                for (std::size_t c = 0; c < 3; ++c) {
                    invalid += !std::isfinite(found[i][c]);
                    sum += std::abs(static_cast<double>(found[i][c]) - static_cast<double>(expected[i][c]));
                }
            CHECK(invalid == 0);
            CHECK(sum / static_cast<double>(3 * found.size()) < 1e-3);
        }
    }

    // Without the light of occluders, it would be 0.59 of the path tracer's.
    TEST_CASE("a red wall in the sun reddens the floor at its foot as in the path tracer's image, to 15 %") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-4, 0, 4), Vec3(8, 0, 0), Vec3(0, 0, -8)}}}, Mat4(), Diffuse{{Rgb(0.8f)}});
        add(scene, QuadList{{{Vec3(-4, 0, -4), Vec3(8, 0, 0), Vec3(0, 2, 0)}}}, Mat4(),
            Diffuse{{Rgb(0.8f, 0.05f, 0.05f)}});
        scene.lights = {SunLight{normalize(Vec3(0, -0.02f, -1)), Rgb(5.0f)}};
        finish_scene(scene);
        const View view{look({0, 2, -1}, {0, 0, -4}, 40), 240, 180};
        const Pinhole pinhole = CameraModel(view).pinhole();
        const ImageRgb found = render(scene, view, {}).radiance, truth = path_traced(scene, view, 64);
        Rgb mean_found, mean_truth;
        int pixels = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 100; x < 140; ++x) {
                const Rayd ray = pinhole.ray({x + 0.5, y + 0.5});
                const double z = ray.at(-ray.origin.y / ray.direction.y).z;
                if (z > -3.99 && z < -3.9) mean_found += found(x, y), mean_truth += truth(x, y), ++pixels;
            }
        CHECK(pixels > 100);
        CHECK(mean_found.r == doctest::Approx(mean_truth.r).epsilon(0.15)); // measured: 1.10 of it
        CHECK(mean_found.g == doctest::Approx(mean_truth.g).epsilon(0.15)); // measured: 1.11
    }

    TEST_CASE("the same bits for any number of threads") {
        Scene scene = white_scene();
        add(scene, torus(24, 12), translation(Vec3(0, 0.5f, 0)));
        finish_scene(scene);
        View view{look({0, 3, 4}, {0, 0.3, 0.7}, 50), 80, 60};
        view.camera.aperture_radius = 0.1;
        CHECK(visible(scene, view, 4, 1).pixels() == visible(scene, view, 4, 5).pixels());
    }
}

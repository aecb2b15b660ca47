// These tests check threads, samples, depth of field and motion blur.
#include "common/image/bitwise_equal.h"
#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

Scene varied() {
    Scene scene;
    add(scene, torus(40, 20), Mat4(rotation(Vec3(1, 0, 0), 0.5f)), Metal{{Rgb(0.9f, 0.8f, 0.7f)}, 0.4f});
    add(scene, Sphere{Vec3(0.2f, 0.9f, 0.3f), 0.4f}, Mat4(), Dielectric{});
    add(scene, QuadList{{{Vec3(-3, -0.6f, 3), Vec3(6, 0, 0), Vec3(0, 0, -6)}}});
    add(scene, QuadList{{{Vec3(-1, 3, -1), Vec3(2, 0, 0), Vec3(0, 0, 2)}}}, Mat4(), Emissive{Rgb(8.0f)});
    Object& mover = add(scene, Sphere{Vec3(0, 0, 0), 0.3f}, Mat4(translation(Vec3(-1.5f, 0, 0))));
    mover.place(mover.to_world, Mat4(translation(Vec3(-1, 0.3f, 0))));
    scene.environment = SkyEnvironment{};
    finish_scene(scene);
    return scene;
}

/// Returns the mean of a row's red channel between two columns.
double mean(const ImageRgb& image, int row, int first, int last) {
    double sum = 0;
    for (int x = first; x < last; ++x) sum += static_cast<double>(image(x, row).r);
    return sum / (last - first);
}

/// Returns settings that show white objects on black, so the image is the coverage.
raster::RasterSettings silhouettes(int samples) {
    raster::RasterSettings settings;
    settings.shading = raster::Shading::kAlbedo;
    settings.samples_per_pixel = samples;
    return settings;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the same bits for 1, 2 and 7 threads, with lens, motion and several samples") {
        const Scene scene = varied();
        for (const double aperture : {0.0, 0.1}) {
            View view{look({2, 2, 4}, {0, 0, 0}, 40), 150, 110};
            view.camera.aperture_radius = aperture;
            std::vector<Rendering> images;
            for (const int threads : {1, 2, 7}) {
                raster::RasterSettings settings;
                settings.threads = threads;
                settings.samples_per_pixel = 5;
                settings.aovs = {
                    .depth = true, .normal = true, .albedo = true, .hit = true, .variance = false, .samples = true};
                images.push_back(render(scene, view, settings));
            }
            for (const Rendering& other : images) {
                CHECK(bitwise_equal(other.radiance, images[0].radiance));
                CHECK(bitwise_equal(other.depth, images[0].depth));
                CHECK(bitwise_equal(other.normal, images[0].normal));
                CHECK(bitwise_equal(other.albedo, images[0].albedo));
                CHECK(bitwise_equal(other.hit, images[0].hit));
                CHECK(other.statistics.invalid_samples == 0);
            }
        }
    }

    TEST_CASE("the same image for any seed with one sample, another with several") {
        const Scene scene = varied();
        const View view{look({2, 2, 4}, {0, 0, 0}, 40), 60, 40};
        const auto shown_image = [&](int samples, std::uint64_t seed) {
            raster::RasterSettings settings;
            settings.samples_per_pixel = samples;
            settings.seed = seed;
            return render(scene, view, settings).radiance;
        };
        CHECK(bitwise_equal(shown_image(1, 1), shown_image(1, 2)));
        CHECK(bitwise_equal(shown_image(4, 1), shown_image(4, 1)));
        CHECK_FALSE(bitwise_equal(shown_image(4, 1), shown_image(4, 2)));
    }

    TEST_CASE("many samples give a pixel the part of its area that is covered") {
        Scene scene;
        add(scene, Sphere{Vec3(0, 0, 0), 1}, Mat4(), Diffuse{{Rgb(1.0f)}});
        finish_scene(scene);
        const View view{look_orthographic({0, 0, 5}, {0, 0, 0}, 4), 32, 32}; // 8 pixels per meter
        const Rendering rendering = render(scene, view, silhouettes(256));
        double area = 0;
        for (const Rgb c : rendering.radiance) area += static_cast<double>(c.r);
        CHECK(area / 64 == doctest::Approx(kPiDouble).epsilon(1e-3));
        CHECK(rendering.statistics.passes == 1);
        CHECK(rendering.statistics.samples_per_pixel == 256);
    }

    TEST_CASE("a pixel's mean does not move with the grid of samples: an edge at any place") {
        for (int i = 0; i < 8; ++i) {
            Scene scene;
            const float edge = 0.1f + 0.1f * static_cast<float>(i); // in pixels of 1 meter each
            add(scene, QuadList{{{Vec3(-8, -8, 0), Vec3(8 + edge, 0, 0), Vec3(0, 16, 0)}}}, Mat4(),
                Diffuse{{Rgb(1.0f)}});
            finish_scene(scene);
            const View view{look_orthographic({0, 0, 5}, {0, 0, 0}, 8), 8, 8};
            const Rendering rendering = render(scene, view, silhouettes(64));
            CHECK(static_cast<double>(rendering.radiance(4, 4).r) ==
                  doctest::Approx(static_cast<double>(edge)).epsilon(0.03));
            CHECK(rendering.radiance(3, 4).r == 1.0f);
            CHECK(rendering.radiance(5, 4).r == 0.0f);
        }
    }

    TEST_CASE("motion blur is as wide as the way, and even along it") {
        Scene scene;
        Object& mover =
            add(scene, QuadList{{{Vec3(-8, -4, 0), Vec3(8, 0, 0), Vec3(0, 8, 0)}}}, Mat4(), Diffuse{{Rgb(1.0f)}});
        mover.place(Mat4(), Mat4(translation(Vec3(2, 0, 0)))); // its right edge moves from x = 0 to x = 2
        finish_scene(scene);
        View view{look_orthographic({0, 0, 5}, {0, 0, 0}, 1), 64, 8}; // 8 pixels per meter: from column 32 to 48
        const Rendering blurred = render(scene, view, silhouettes(256));
        for (int x = 0; x < 64; ++x) {
            const double expected = std::clamp((48 - (x + 0.5)) / 16, 0.0, 1.0);
            CHECK(static_cast<double>(blurred.radiance(x, 4).r) == doctest::Approx(expected).epsilon(0.02));
        }
        CHECK(blurred.statistics.passes == 256);
        const Rendering still = render(scene, view, silhouettes(1)); // when the shutter opens
        CHECK(still.radiance(31, 4).r == 1.0f);
        CHECK(still.radiance(32, 4).r == 0.0f);
        view.camera.shutter_open = view.camera.shutter_close = 0.5;
        CHECK(mean(render(scene, view, silhouettes(4)).radiance, 4, 0, 64) == doctest::Approx(40.0 / 64));
    }

    TEST_CASE("a point out of focus becomes a disk of the right width, in focus it stays sharp") {
        View view{look({0, 0, 10}, {0, 0, 0}), 65, 65};
        view.camera.aperture_radius = 0.2;
        view.camera.focus_distance = 10;
        view.camera.fov_degrees =
            degrees(2 * std::atan(0.25));     // the plane in focus is 5 meters high: 13 pixels per meter
        const auto width = [&](float depth) { // the number of columns of the middle row that a tiny sphere covers
            Scene scene;
            add(scene, Sphere{Vec3(0, 0, 10 - depth), 0.004f * depth}, Mat4(), Diffuse{{Rgb(1.0f)}});
            finish_scene(scene);
            const Rendering rendering = render(scene, view, silhouettes(1500));
            int columns = 0;
            for (int x = 0; x < 65; ++x) columns += rendering.radiance(x, 32).r > 0;
            return columns;
        };
        CHECK(width(10) <= 3);
        // At half the focus distance, the circle of confusion in the plane of focus is as wide as the aperture, 0.4
        // m. That is 5.2 pixels, plus 1 pixel for the sphere itself.
        const int near = width(5);
        CHECK(near >= 5);
        CHECK(near <= 8);
        // At a quarter of the focus distance it is three times as wide: 15.6 pixels.
        const int nearer = width(2.5f);
        CHECK(nearer >= 15);
        CHECK(nearer <= 19);
    }

    TEST_CASE("progress never decreases, reaches 1, and stopping keeps what is finished") {
        const Scene scene = varied();
        const View view{look({2, 2, 4}, {0, 0, 0}, 40), 450, 330};
        raster::RasterSettings settings;
        settings.samples_per_pixel = 4;
        settings.threads = 3;
        const raster::RasterScene prepared = raster::prepare(scene, settings);
        double last = 0;
        bool ordered = true;
        Control control;
        control.progress = [&](double f) {
            ordered = ordered && f >= last;
            last = f;
        };
        const Rendering whole = raster::render(prepared, view, settings, control);
        CHECK(ordered);
        CHECK(last == 1);
        CHECK_FALSE(whole.statistics.interrupted);

        std::atomic<bool> stop{false};
        control.stop = &stop;
        control.progress = [&](double f) { stop = f > 0.6; }; // after the third of four passes
        const Rendering part = raster::render(prepared, view, settings, control);
        CHECK(part.statistics.interrupted);
        CHECK(part.statistics.passes == 3);
        CHECK(part.statistics.samples_per_pixel == 3);
        const int black = static_cast<int>(std::count(part.radiance.begin(), part.radiance.end(), Rgb()));
        CHECK(black == 0); // each pixel has the mean of its finished samples

        stop = true;
        const Rendering none = raster::render(prepared, view, settings, control);
        CHECK(none.statistics.interrupted);
        CHECK(std::all_of(none.radiance.begin(), none.radiance.end(), [](Rgb c) { return c == Rgb(); }));
    }

    TEST_CASE("settings and sizes that can't be rendered are refused") {
        const Scene scene = varied();
        raster::RasterSettings settings;
        CHECK_THROWS_AS(render(scene, {Camera{}, 0, 10}, settings), Error);
        CHECK_THROWS_AS(render(scene, {Camera{}, 10, 100000}, settings), Error);
        settings.samples_per_pixel = 0;
        CHECK_THROWS_AS(render(scene, {Camera{}, 10, 10}, settings), Error);
    }
}

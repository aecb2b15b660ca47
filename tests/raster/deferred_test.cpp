// These tests compare deferred shading with closed forms and with the path tracer.
#include "tests/raster/path_traced.h"
#include "tests/raster/varied_scene.h"

#include "common/system/file.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

Scene load_model(const char* name) { return load_scene(std::filesystem::path(DUET_SOURCE_DIR) / "models" / name); }

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("in a white furnace every surface is as bright as the environment") {
        for (const Material& material : {Material{Diffuse{{Rgb(1.0f)}}}, Material{Metal{{Rgb(1.0f)}, {0}}},
                                         Material{Metal{{Rgb(1.0f)}, {0.6f}}}, Material{Dielectric{1.5f}}}) {
            Scene scene;
            add(scene, Sphere{Vec3(0, 0, 0), 1}, Mat4(), material);
            scene.environment = ConstantEnvironment{Rgb(1.0f)};
            finish_scene(scene);
            for (const Rgb c : render(scene, {look({0, 0, 5}, {0, 0, 0}), 40, 40}, {}).radiance)
                CHECK(c.g == doctest::Approx(1).epsilon(0.03));
        }
    }

    TEST_CASE("the background is the environment's radiance along each camera ray, at the zenith and the seam, too") {
        Scene scene;
        add(scene, Sphere{Vec3(0, 0, 0), 1});
        ImageRgb image(16, 8);
        for (std::size_t i = 0; i < image.pixels().size(); ++i)
            image.pixels()[i] = Rgb(static_cast<float>(i * 7 % 11), static_cast<float>(i * 5 % 13), 1);
        const Camera level = look({0, 0, 5}, {0, 0, 9}, 120);
        Camera upwards = look({0, 5, 0}, {0, 9, 0}, 120); // the middle of the image is the zenith itself
        upwards.up = {0, 0, 1};
        Camera parallel = level, zenith = upwards;
        parallel.projection = zenith.projection = Camera::Projection::kOrthographic;
        float worst = 0;
        for (const float rotation : {0.0f, -2.0f, 40.0f})
            for (const Environment& environment :
                 {Environment{make_image_environment(image, 0.7f, rotation)}, Environment{SkyEnvironment{}}})
                for (const Camera& camera : {level, upwards, parallel, zenith}) {
                    scene.camera = camera, scene.environment = environment;
                    finish_scene(scene);
                    const View view{scene.camera, 91, 61};
                    const CameraModel rays(view);
                    const ImageRgb found = render(scene, view, {}).radiance;
                    for (int y = 0; y < view.height; ++y)
                        for (int x = 0; x < view.width; ++x) {
                            const Vec3 w = rays.ray({x + 0.5, y + 0.5}).direction;
                            const Rgb seen = found(x, y), expected = radiance(environment, w);
                            REQUIRE(is_finite(seen));
                            if (w.x == 0 && w.z == 0) continue; // the zenith has any longitude
                            worst = std::max(worst, max_component(Rgb(std::abs(seen.r - expected.r),
                                                                      std::abs(seen.g - expected.g),
                                                                      std::abs(seen.b - expected.b))));
                        }
                }
        CHECK(worst < 1e-4f);
    }

    TEST_CASE("the image is the same for any number of threads") {
        const Scene scene = varied_scene(24);
        raster::RasterSettings settings;
        settings.threads = 1;
        const Rendering one = render(scene, perspective(), settings);
        settings.threads = 3;
        CHECK(one.radiance.pixels() == render(scene, perspective(), settings).radiance.pixels());
    }

    TEST_CASE("several samples per pixel average images of one sample") {
        const Scene scene = varied_scene(16);
        raster::RasterSettings settings;
        settings.samples_per_pixel = 4;
        const Rendering smooth = render(scene, {perspective().camera, 60, 40}, settings);
        CHECK(smooth.statistics.samples_per_pixel == 4);
        settings.samples_per_pixel = 1;
        // Edges differ; flat regions don't.
        CHECK(relmse(render(scene, {perspective().camera, 60, 40}, settings).radiance, smooth.radiance) < 0.02);
    }
}

TEST_SUITE("image") {

    // Light between surfaces counts here: without it relMSE is 0.045. The reference's own error is about 0.0005.
    TEST_CASE("the Cornell box is that of the path tracer") {
        const Scene scene = load_model("cornell.json");
        const View view{scene.camera, 96, 96};
        CHECK(relmse(render(scene, view, {}).radiance, path_traced(scene, view, 256)) < 0.006);
    }
    // A narrow ring of the sphere refracts the light's radiance at a grazing angle. The pixels whose center it meets
    // would be bright dots.
    TEST_CASE("a glass sphere under an area light has no bright dots at its lower rim") {
        const Scene scene = load_model("glass.json");
        const raster::RasterScene prepared = raster::prepare(scene, raster::RasterSettings{});
        for (const int side : {180, 190, 200, 210, 220}) {
            Control control;
            const ImageRgb image =
                raster::render(prepared, {scene.camera, side, side}, raster::RasterSettings{}, control).radiance;
            float brightest = 0;
            for (int y = side * 3 / 4; y < side; ++y)
                for (int x = 0; x < side; ++x) brightest = std::max(brightest, image(x, y).g);
            CHECK(brightest < 0.8f);
        }
    }
    TEST_CASE("a glass sphere in a box is that of the path tracer, but for its caustic") {
        const Scene scene = load_model("glass.json");
        const View view{scene.camera, 96, 96};
        CHECK(relmse(render(scene, view, {}).radiance, path_traced(scene, view, 256)) < 0.022);
    }
}

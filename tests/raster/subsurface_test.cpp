// These tests check the blur of subsurface scattering against the profile that it stands for.
#include "raster/screen_space/subsurface.h"

#include "common/image/bitwise_equal.h"
#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raster;

namespace {

constexpr int kWidth = 256, kHeight = 192;
constexpr float kPixel = 0.001f; // meters

/// Returns a solid of this mean free path.
Coated solid(Rgb albedo, Rgb mean_free_path) { return Coated{{albedo}, 0.3f, 1.5f, mean_free_path}; }

/// Returns the G-buffer of a plane in front of the camera.
GBuffer plane(Rgb albedo) {
    const Camera camera = test::look({0, 0, 1}, {0, 0, 0}, 2 * std::atan(kPixel * kHeight / 2.0) * 180 / kPiDouble);
    GBuffer gbuffer(ScreenProjection(CameraModel(View{camera, kWidth, kHeight}).pinhole(), SampleOffset()), kWidth,
                    kHeight, {});
    gbuffer.reversed_depth.fill(gbuffer.projection.near());
    gbuffer.normal.z.fill(1);
    gbuffer.material.fill(0);
    gbuffer.diffuse.x.fill(albedo.r), gbuffer.diffuse.y.fill(albedo.g), gbuffer.diffuse.z.fill(albedo.b);
    return gbuffer;
}

/// Returns the fraction of the light of a profile of parameter b that comes farther than x along one axis, on one side.
double beyond(double b, double x) {
    constexpr int kSteps = 2000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double r = b * x / std::cos((i + 0.5) / kSteps * kPiDouble / 2);
        sum += (std::exp(-r) + 3 * std::exp(-r / 3)) / 8;
    }
    return sum / kSteps;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the light beyond an edge is what the profile sends there") {
        Scene scene;
        const Rgb albedo(0.8f, 0.5f, 0.2f), paths(0.002f, 0.001f, 0.0005f);
        test::add(scene, QuadList{}, Mat4(), solid(albedo, paths));
        const SolidMaterials materials(scene);
        GBuffer gbuffer = plane(albedo);
        for (const bool columns : {false, true}) {
            CAPTURE(columns);
            const int middle = columns ? kHeight / 2 : kWidth / 2;
            Planes3 light(kWidth, kHeight);
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) light.set_at(x, y, Rgb((columns ? y : x) < middle ? 1.0f : 0.0f));
            blur_solid_light(materials, gbuffer, 2, light);
            const float back = std::get<Coated>(scene.materials[0]).internal_reflectance();
            for (std::size_t c = 0; c < 3; ++c) {
                CAPTURE(c);
                const float inside = albedo[c] / (1 - back + albedo[c] * back);
                const double b = static_cast<double>(diffusion_profile::scale(albedo[c]) /
                                                     (paths[c] * free_path_factor(inside, back)));
                for (int k = -30; k < 30; ++k) {
                    CAPTURE(k);
                    const double x = (k + 0.5) * static_cast<double>(kPixel);
                    const double truth = k < 0 ? 1 - beyond(b, -x) : beyond(b, x);
                    const Rgb found =
                        columns ? light.color_at(kWidth / 2, middle + k) : light.color_at(middle + k, kHeight / 2);
                    CHECK(std::abs(static_cast<double>(found[c]) - truth) < 0.02);
                }
            }
        }
    }

    TEST_CASE("even light stays, and light stays on its side of a step in depth, and within solids") {
        Scene scene;
        test::add(scene, QuadList{}, Mat4(), solid(Rgb(0.8f), Rgb(0.01f)));
        test::add(scene, QuadList{}, Mat4(), Coated{});
        const SolidMaterials materials(scene);
        GBuffer gbuffer = plane(Rgb(0.5f));
        Planes3 light(kWidth, kHeight);
        for (PlaneFloat* channel : {&light.x, &light.y, &light.z}) channel->fill(0.7f);
        blur_solid_light(materials, gbuffer, 2, light);
        for (int x = 0; x < kWidth; ++x) CHECK(light.x(x, 9) == doctest::Approx(0.7f).epsilon(1e-5));

        for (const bool step : {false, true}) { // a step to a third of the distance, or another material
            CAPTURE(step);
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) {
                    light.set_at(x, y, Rgb(x < 100 ? 1.0f : 0.0f));
                    if (x >= 100 && step) gbuffer.reversed_depth(x, y) = 3 * gbuffer.projection.near();
                    gbuffer.material(x, y) = x >= 100 && !step ? 1 : 0;
                }
            blur_solid_light(materials, gbuffer, 2, light);
            for (int x = 0; x < kWidth; ++x) CHECK(light.x(x, 9) == doctest::Approx(x < 100 ? 1 : 0).epsilon(1e-5));
        }
    }

    TEST_CASE("solids change their own light only, which is the same for any number of threads") {
        const auto render = [](Rgb mean_free_path, bool subsurface, int threads) {
            Scene scene;
            scene.camera = test::look({0, 1, 4}, {0, 0, 0});
            test::add(scene, Sphere{{0, 0, 0}, 1}, Mat4(), solid(Rgb(0.8f), mean_free_path));
            test::add(scene, QuadList{{Quad{{-3, -1, 3}, {6, 0, 0}, {0, 0, -6}}}});
            scene.lights = {PointLight{{3, 4, 0}, Rgb(30.0f)}};
            finish_scene(scene);
            RasterSettings settings;
            settings.subsurface = subsurface;
            settings.threads = threads;
            settings.aovs.hit = true;
            return test::render(scene, View{scene.camera, 160, 120}, settings);
        };
        const Rendering on = render(Rgb(0.1f), true, 1), off = render(Rgb(0.1f), false, 1);
        CHECK(bitwise_equal(on.radiance, render(Rgb(0.1f), true, 3).radiance));
        CHECK(bitwise_equal(off.radiance, render(Rgb(), true, 1).radiance));
        int differ = 0;
        for (std::size_t i = 0; i < on.radiance.size(); ++i) {
            if (on.hit[i].object != 0) CHECK(bitwise_equal(on.radiance[i], off.radiance[i]));
            differ += !(on.radiance[i] == off.radiance[i]);
        }
        CHECK(differ > 1000);
    }
}

// These tests check the rasterizer's shading of given hits, split into components.
#include "raster/shading/light_components.h"

#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

Scene all_materials() {
    Scene scene;
    add(scene, QuadList{{Quad{{-3, -1, 3}, {6, 0, 0}, {0, 0, -6}}}}, {}, Diffuse{{Rgb(0.6f, 0.5f, 0.4f)}});
    add(scene, Sphere{{-1.2f, 0, 0}, 0.7f}, {}, Metal{{Rgb(0.9f, 0.7f, 0.4f)}, 0.5f});
    add(scene, Sphere{{0.2f, 0, 0}, 0.6f}, {}, Dielectric{1.5f, {Rgb(0.9f)}});
    add(scene, Sphere{{1.4f, 0, 0}, 0.5f}, {}, Metal{{Rgb(0.9f)}, 0});
    add(scene, QuadList{{Quad{{-1, 2.5f, -1}, {2, 0, 0}, {0, 0, 1}}}}, {}, Emissive{Rgb(4), true, {Rgb(0.3f)}});
    scene.lights.push_back(PointLight{{2, 2, 2}, Rgb(5)});
    scene.environment = SkyEnvironment{};
    scene.camera = look({0, 1.5, 6}, {0, 0.5, 0}, 50);
    finish_scene(scene);
    return scene;
}

const View kView{look({0, 1.5, 6}, {0, 0.5, 0}, 50), 60, 40};

double largest_difference(const ImageRgb& a, const ImageRgb& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            largest = std::max(largest, std::abs(static_cast<double>(a[i][c]) - static_cast<double>(b[i][c])));
    return largest;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the hits of a picture, shaded one by one, give the picture; with and without the environment") {
        const Scene scene = all_materials();
        for (const bool environment : {true, false}) {
            raster::RasterSettings settings;
            settings.environment = environment;
            settings.aovs.hit = true;
            const raster::RasterScene prepared = raster::prepare(scene, settings);
            Control control;
            const Rendering picture = raster::render(prepared, kView, settings, control);
            const std::shared_ptr<const raster::ScreenGBuffer> gbuffer =
                raster::make_screen_gbuffer(prepared, kView, settings);
            const CameraModel camera(kView);
            ImageRgb shaded(kView.width, kView.height), again = shaded;
            for (int y = 0; y < kView.height; ++y)
                for (int x = 0; x < kView.width; ++x) {
                    const Ray ray = camera.ray({x + 0.5, y + 0.5});
                    const Hit hit = picture.hit(x, y);
                    shaded(x, y) = again(x, y) =
                        raster::shade_hit(prepared, settings, ray, hit, nullptr, gbuffer.get()).sum();
                    if (!hit.valid()) continue;
                    const SurfacePoint point = surface_point(scene, ray, hit);
                    const Bsdf bsdf = bsdf_at(scene.materials[point.material], scene.textures, point);
                    again(x, y) =
                        raster::shade_surface(prepared, settings, point, bsdf, -ray.direction, gbuffer.get()).sum();
                }
            CHECK(largest_difference(picture.radiance, shaded) < 1e-5);
            CHECK(largest_difference(shaded, again) == 0);
        }
    }

    TEST_CASE("each part rendered alone is that part; together they are the picture") {
        const Scene scene = all_materials();
        const raster::LightComponentSet none{
            .emission = false, .direct = false, .environment = false, .reflection = false};
        raster::RasterSettings settings;
        const Rendering whole = render(scene, kView, settings);
        ImageRgb sum(kView.width, kView.height);
        for (bool raster::LightComponentSet::*const part :
             {&raster::LightComponentSet::emission, &raster::LightComponentSet::direct,
              &raster::LightComponentSet::environment, &raster::LightComponentSet::reflection}) {
            settings.components = none;
            settings.components.*part = true;
            const Rendering alone = render(scene, kView, settings);
            double light = 0;
            for (std::size_t i = 0; i < sum.size(); ++i) {
                sum[i] += alone.radiance[i];
                light += static_cast<double>(alone.radiance[i].g);
            }
            CHECK(light > 1);
            CHECK(light < 0.9 * 2400 * 4);
            CHECK(std::any_of(alone.statistics.skipped.begin(), alone.statistics.skipped.end(),
                              [](const SkippedWork& s) { return s.why == "turned off"; }));
        }
        CHECK(largest_difference(whole.radiance, sum) < 1e-6);
        settings.components = none;
        CHECK(largest_difference(render(scene, kView, settings).radiance, ImageRgb(kView.width, kView.height)) == 0);
    }

    TEST_CASE("a surface's light goes to the part of its material") {
        const Scene scene = all_materials();
        const raster::RasterSettings settings;
        const raster::RasterScene prepared = raster::prepare(scene, settings);
        SurfacePoint point;
        point.p = {0.3f, 0, 1};
        point.ng = point.ns = point.terminator_normal = {0, 1, 0};
        const Vec3 to_viewer = normalize(Vec3(0.2f, 1, 0.3f));
        const auto shade = [&](const Bsdf& bsdf) {
            return raster::shade_surface(prepared, settings, point, bsdf, to_viewer);
        };
        const raster::LightComponents diffuse = shade(DiffuseBsdf{Rgb(0.5f)}),
                                      rough = shade(MetalBsdf{Rgb(0.9f), 0.3f}),
                                      mirror = shade(MetalBsdf{Rgb(0.9f), 0}),
                                      glass = shade(DielectricBsdf{1.5f, Rgb(1)});
        CHECK(diffuse.direct.g > 0);
        CHECK(diffuse.environment.g > 0);
        CHECK(is_black(diffuse.reflection));
        CHECK(rough.direct.g > 0);
        for (const raster::LightComponents& parts : {rough, mirror, glass}) {
            CHECK(is_black(parts.environment));
            CHECK(parts.reflection.g > 0);
        }
        CHECK(is_black(mirror.direct));
        CHECK(is_black(glass.direct));
    }
}

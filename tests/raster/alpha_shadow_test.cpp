// These tests check shadows of alpha-masked and partly transparent surfaces.
#include "tests/raster/shadow_floor.h"

#include "raster/shadows/shadow_map.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

TEST_SUITE("unit") {

    TEST_CASE("a cut-out lattice under each kind of light: dark and light cells where the light's rays take them, to a "
              "texel") {
        enum { kSun, kSpot, kPoint };
        for (const int kind : {kSun, kSpot, kPoint}) {
            Scene scene = floor_scene();
            add(scene, QuadList{{{Vec3(-0.5f, 1, 0.5f), Vec3(1, 0, 0), Vec3(0, 0, -1)}}});
            scene.textures.textures = {CheckerTexture{Rgb(1), Rgb(0), 4}};
            scene.maps.resize(2);
            scene.maps[1].opacity = {1, 0};
            scene.maps[1].cutoff = 0.5f;
            const Vec3 way = normalize(Vec3(0.4f, -1, 0.2f));
            if (kind == kSun) scene.lights.push_back(SunLight{way, Rgb(2)});
            if (kind == kSpot) scene.lights.push_back(SpotLight{Vec3(0, 3, 0), Vec3(0, -1, 0), Rgb(20), 0.8f, 0.7f});
            if (kind == kPoint) scene.lights.push_back(PointLight{Vec3(0, 3, 0), Rgb(20)});
            finish_scene(scene);
            raster::RasterSettings settings = direct_light_only();
            settings.shadow_map_side = 2048;
            const double half = kind == kSun ? 0.5 : 0.75, cell = half / 2;
            const Vec3d middle = kind == kSun ? Vec3d(0.4, 0, 0.2) : Vec3d();
            const double texel = 8.0 / (settings.shadow_map_side / (kind == kPoint ? 2 : 1));
            CAPTURE(kind);
            check_outline(
                visible(scene, over_floor(), settings),
                [&](Vec3d p) {
                    const double x = p.x - middle.x + half, z = middle.z + half - p.z; // along u and v
                    const double beyond = half - max(std::abs(x - half), std::abs(z - half));
                    if (beyond < 0) return beyond;
                    const auto to_line = [&](double at) { return std::abs(at - std::round(at / cell) * cell); };
                    const bool even = (static_cast<int>(x / cell) + static_cast<int>(z / cell)) % 2 == 0;
                    return even ? min(to_line(x), to_line(z)) : -min(to_line(x), to_line(z));
                },
                (kFilterRadius + 1) * texel, 8 * 4 * cell, texel / 2);
        }
    }

    // The shadow map dithers with a fixed matrix. The filter of hard shadows leaves the error of one of its 16
    // levels: at most half a sixteenth, rms. Soft shadows leave more. If the error were random with an rms of 0.2 of
    // the light, a mean of at least 3300 pixels would be off by 0.017 or more with a probability of 10^-6.
    TEST_CASE("layers let the part of the light through that they do not stop, one or stacked, quads and balls, "
              "whatever the light") {
        enum { kSun, kSpot, kPoint, kAreaLight };
        struct TranslucentLayers {
            int count;
            float opacity;
            bool ball;
        };
        for (const TranslucentLayers layers :
             {TranslucentLayers{1, 0.5f, false}, TranslucentLayers{1, 0.45f, false}, TranslucentLayers{1, 0.1f, false},
              TranslucentLayers{2, 0.5f, false}, TranslucentLayers{3, 0.3f, false}, TranslucentLayers{1, 0.4f, true}})
            for (const int kind : {kSun, kSpot, kPoint, kAreaLight}) {
                Scene scene = floor_scene();
                for (int i = 0; i < layers.count; ++i) {
                    const float y = 1 + 0.1f * static_cast<float>(i);
                    const QuadList sheet{{{Vec3(-1, y, 1), Vec3(2, 0, 0), Vec3(0, 0, -2)}}};
                    add(scene, layers.ball ? Shape(Sphere{Vec3(0, 1, 0), 0.8f}) : Shape(sheet));
                    scene.maps.resize(scene.materials.size());
                    scene.maps.back().opacity = layers.opacity;
                }
                if (kind == kSun) scene.lights.push_back(SunLight{normalize(Vec3(0.1f, -1, 0.05f)), Rgb(2)});
                if (kind == kSpot)
                    scene.lights.push_back(SpotLight{Vec3(0, 4, 0), Vec3(0, -1, 0), Rgb(20), 0.8f, 0.7f});
                if (kind == kPoint) scene.lights.push_back(PointLight{Vec3(0, 4, 0), Rgb(20)});
                if (kind == kAreaLight)
                    add(scene, QuadList{{{Vec3(-0.1f, 4, -0.1f), Vec3(0.2f, 0, 0), Vec3(0, 0, 0.2f)}}}, Mat4(),
                        Emissive{Rgb(50)});
                finish_scene(scene);
                const ImageFloat found = visible(scene, over_floor(0.1));
                double sum = 0, squares = 0;
                int pixels = 0;
                for (int y = 0; y < kSize; ++y)
                    for (int x = 0; x < kSize; ++x) {
                        const Vec3d p = floor_point(x, y); // both sides of the sphere are between it and the light
                        if (layers.ball ? length(p) > 0.65 : max(std::abs(p.x), std::abs(p.z)) > 0.8) continue;
                        sum += static_cast<double>(found(x, y));
                        squares += sqr(static_cast<double>(found(x, y)));
                        ++pixels;
                    }
                const double mean = sum / pixels, rms = std::sqrt(max(squares / pixels - sqr(mean), 0.0));
                CAPTURE(kind);
                CAPTURE(layers.count);
                CAPTURE(layers.opacity);
                CAPTURE(layers.ball);
                CHECK(pixels >= 3300);
                // The few taps of a soft shadow may all miss a thin layer, or one of two layers. Measured: 0.039,
                // 0.107.
                const double tolerance = kind != kAreaLight ? 0.017 : layers.ball ? 0.11 : 0.042;
                CHECK(std::abs(mean - std::pow(1 - static_cast<double>(layers.opacity),
                                               layers.ball ? 2 : layers.count)) < tolerance);
                CHECK(rms < (kind == kAreaLight ? 0.22 : 1.0 / 32 + 0.002));
            }
    }

    TEST_CASE("what may be seen through does not shade itself, and a sheet is shaded by what is whole before it") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4)}}});
        scene.maps.resize(1);
        scene.maps[0].opacity = 0.5f;
        scene.camera = over_floor().camera;
        scene.lights.push_back(SunLight{normalize(Vec3(0.4f, -1, 0.2f)), Rgb(2)});
        Scene shaded = scene;
        finish_scene(scene);
        for (const float part : visible(scene, over_floor())) CHECK(part == 1);
        add(shaded, QuadList{{{Vec3(-3, 1, 3), Vec3(6, 0, 0), Vec3(0, 0, -6)}}});
        finish_scene(shaded);
        CHECK(visible(shaded, over_floor())(kSize / 2, kSize / 2) == 0);
    }

    // If the roof on a wall is opaque, the wall is dark as soon as the four texels around a point contain the roof.
    TEST_CASE("a sheet that lies on a steep wall covers no place of it whole, though all texels about the place be "
              "stopped by it") {
        for (const float opacity : {0.2f, 0.5f})
            for (const Vec3 way : {Vec3(-0.5f, -0.75f, -0.4f), Vec3(-0.3f, -1, 0), Vec3(-0.1f, -1, 0)}) {
                Scene scene = floor_scene();
                add(scene, QuadList{{{Vec3(0, 0, 2), Vec3(0, 0, -4), Vec3(0, 1, 0)}}}); // the wall, viewed from +x
                add(scene, QuadList{{{Vec3(-0.2f, 1, 2), Vec3(3, 0, 0), Vec3(0, 0, -4)}}});
                scene.maps.resize(3);
                scene.maps.back().opacity = opacity;
                scene.lights.push_back(SunLight{normalize(way), Rgb(2)});
                finish_scene(scene);
                raster::RasterSettings settings = direct_light_only();
                settings.shadow_map_side = 512;
                const Camera camera = look_orthographic({0.5, 0.95, 0}, {0, 0.95, 0}, 0.1); // at the top of the wall
                const ImageFloat found = visible(scene, {camera, 100, 100}, settings);
                CAPTURE(opacity);
                CAPTURE(way.x);
                CHECK(*std::ranges::min_element(found) > 0.25f * (1 - opacity));
            }
    }
}

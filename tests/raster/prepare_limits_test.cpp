// These tests check that prepare() renders nothing finer than a small image shows.
#include "raster/prepare_limits.h"
#include "raster/render.h"

#include <doctest/doctest.h>

using namespace duet;
using raster::PrepareLimits;

namespace {

PrepareLimits limits(int width, int height) {
    Scene scene;
    scene.width = width;
    scene.height = height;
    return PrepareLimits(scene);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("limits: none from 256 x 256 pixels on but for large maps, less for smaller images, never nothing") {
        CHECK(limits(480, 480).radiance_map_side(512) == 256);
        CHECK(limits(512, 512).radiance_map_side(512) == 512);
        for (const auto& large : {limits(256, 256), limits(640, 480), limits(16384, 16384)}) {
            CHECK(large.shadow_map_side(2048) == 2048);
            CHECK(large.radiance_map_side(256) == 256);
            CHECK(large.irradiance_probes(512) == 512);
            CHECK(large.reflection_probes(96) == 96);
        }
        const PrepareLimits small = limits(32, 32), least = limits(1, 1);
        CHECK(small.shadow_map_side(2048) == 256);
        CHECK(small.radiance_map_side(256) == 128);
        CHECK(small.irradiance_probes(512) == 64);
        CHECK(small.reflection_probes(96) == 16);
        CHECK(least.shadow_map_side(2048) == 64);
        CHECK(least.radiance_map_side(256) == 64);
        CHECK(least.irradiance_probes(512) == 1);
        CHECK(least.reflection_probes(96) == 1);
    }

    TEST_CASE("limits: a small image of a scene with lights and mirrors needs a small part of the memory") {
        Scene scene = load_scene(std::string(DUET_SOURCE_DIR) + "/models/spheres.json");
        const auto bytes = [&](int width, int height) {
            scene.width = width;
            scene.height = height;
            raster::RasterSettings settings;
            Control control;
            const View view{scene.camera, 8, 8};
            return raster::render(raster::prepare(scene, settings), view, settings, control).statistics.memory_bytes;
        };
        CHECK(bytes(32, 24) * 4 < bytes(256, 256));
    }

    TEST_CASE("limits: a scene without light needs no maps and no probes, and its image is black") {
        Scene scene = load_scene(std::string(DUET_SOURCE_DIR) + "/models/spheres.json");
        const auto rendered = [&] {
            finish_scene(scene);
            const View view{scene.camera, 16, 12};
            Control control;
            return raster::render(raster::prepare(scene, {}), view, {}, control);
        };
        const auto lit = rendered();
        scene.environment = ConstantEnvironment{Rgb(0.0f)};
        scene.lights = {SunLight{{0, -1, 0}, Rgb(0.0f)}};
        for (Material& material : scene.materials)
            if (auto* emissive = std::get_if<Emissive>(&material)) emissive->radiance = Rgb(0.0f);
        const auto dark = rendered();
        CHECK(dark.statistics.memory_bytes * 4 < lit.statistics.memory_bytes);
        CHECK(std::ranges::all_of(dark.radiance.pixels(), [](Rgb pixel) { return is_black(pixel); }));
        CHECK(std::ranges::none_of(lit.radiance.pixels(), [](Rgb pixel) { return is_black(pixel); }));
    }
}

// These tests compare simple scenes that are seen from inside, through glass or in a mirror with the path tracer.
#include "tests/raster/path_traced.h"

#include "common/scene/scene.h"
#include "raster/render.h"

#include <doctest/doctest.h>

#include <string>

using namespace duet;
using namespace duet::test;

namespace {

Scene scene_of(const std::string& text) { return parse_scene("test.json", text); }

double rasterized_mean(const Scene& scene) {
    Control control;
    const raster::RasterSettings settings;
    const View view{scene.camera, scene.width, scene.height};
    return mean_green(raster::render(raster::prepare(scene, settings), view, settings, control).radiance);
}

double traced_mean(const Scene& scene) {
    return mean_green(path_traced(scene, {scene.camera, scene.width, scene.height}, 64));
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a closed room is dark inside while the sun shines outside") {
        for (const std::string room : {R"("type": "box", "low": [-2, -1, -2], "high": [2, 1, 2])",
                                       R"("type": "sphere", "center": [0, 0, 0], "radius": 2)"}) {
            CAPTURE(room);
            const Scene scene = scene_of(R"({
                "camera": {"eye": [0, 0, 1], "look_at": [0, -0.2, 0]}, "image": {"width": 48, "height": 48},
                "materials": {"white": {"type": "diffuse", "albedo": 0.8}},
                "objects": [{)" + room + R"(, "material": "white"}],
                "lights": [{"type": "sun", "direction": [0.3, -1, 0.2], "irradiance": 3},
                           {"type": "point", "position": [0, 6, 0], "intensity": 100}]})");
            CHECK(rasterized_mean(scene) < 4e-3); // in the edges of the box; measured: 0.0019
        }
    }

    TEST_CASE("the tint of glass varies with its texture") {
        for (const std::string even : {"0.1", "0.5", "0.9"}) {
            CAPTURE(even);
            const Scene scene = scene_of(R"({
                "camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0], "fov_degrees": 15},
                "image": {"width": 48, "height": 48}, "environment": {"type": "constant", "radiance": 1},
                "textures": {"squares": {"type": "checker", "even": )" + even + R"(, "odd": 0.9, "scale": 8}},
                "materials": {"glass": {"type": "dielectric", "ior": 1.5, "thin": true,
                                        "tint": {"texture": "squares"}}},
                "objects": [{"type": "quad", "corner": [-2, -2, 0], "u": [4, 0, 0], "v": [0, 4, 0],
                             "material": "glass"}]})");
            CHECK(rasterized_mean(scene) == doctest::Approx(traced_mean(scene)).epsilon(0.03).scale(0));
        }
    }

    TEST_CASE("a mirror shows surfaces with opacity") {
        for (const std::string opacity : {"1", "0.9", "0.5"}) {
            CAPTURE(opacity);
            const Scene scene = scene_of(R"({
                "camera": {"eye": [0, 0, 2], "look_at": [0, 0, 0], "fov_degrees": 30},
                "image": {"width": 48, "height": 48},
                "materials": {"mirror": {"type": "metal", "reflectance": 0.9, "roughness": 0},
                              "wall": {"type": "diffuse", "albedo": 0.8, "opacity": )" + opacity + R"(}},
                "objects": [{"type": "quad", "corner": [-1, -1, 0], "u": [2, 0, 0], "v": [0, 2, 0],
                             "material": "mirror"},
                            {"type": "quad", "corner": [-3, -3, 4], "u": [0, 6, 0], "v": [6, 0, 0],
                             "material": "wall"}],
                "lights": [{"type": "sun", "direction": [1, 0.3, 1], "irradiance": 3}]})");
            // Measured: 0.14.
            CHECK(rasterized_mean(scene) == doctest::Approx(traced_mean(scene)).epsilon(0.2).scale(0));
        }
    }
}

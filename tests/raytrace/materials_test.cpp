// These tests check that renders with and without light sampling agree for every material.
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

/// Returns a sphere on a floor under a large light and a dim sky.
Scene ball(const Material& material) {
    SceneBuilder builder;
    builder.add(quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), builder.material(Diffuse{{Rgb(0.6f)}}));
    builder.add(quad({-1.5f, 3, -1.5f}, {3, 0, 0}, {0, 0, 3}), builder.material(Emissive{Rgb(2.0f)}));
    builder.add(Sphere{{0, 1, 0}, 1}, builder.material(material));
    builder.scene.environment = SkyEnvironment{Rgb(0.1f), Rgb(0.4f)};
    builder.scene.camera.eye = {0, 1.5, 4.5};
    builder.scene.camera.look_at = {0, 1, 0};
    return builder.finish();
}

} // namespace

TEST_SUITE("statistical") {

    // The bound is 6 standard errors over ten seeds each, which is exceeded by chance once in 90,000 times per
    // material.
    TEST_CASE("naive path tracing and light samples agree on each material") {
        Diffuse clay{{Rgb(0.7f)}};
        clay.roughness = 1;
        Metal gold;
        gold.conductor = *find_conductor("gold");
        gold.roughness = 0.6f;
        Dielectric frosted, drop, pane;
        frosted.roughness = 0.6f;
        frosted.absorption = Rgb(0.2f, 0.5f, 0.9f);
        drop.absorption = Rgb(0.2f, 0.5f, 0.9f);
        drop.priority = 1;
        pane.thin = true;
        Principled paint{{Rgb(0.7f, 0.4f, 0.2f)}, 0.5f, 0.6f};
        paint.clearcoat = 1;
        paint.clearcoat_roughness = 0.4f;
        for (const Material& material : {Material(clay), Material(gold), Material(frosted), Material(drop),
                                         Material(pane), Material(Coated{{Rgb(0.7f)}, 0.4f}), Material(paint)}) {
            CAPTURE(material.index());
            const Scene scene = ball(material);
            PathTracerSettings settings;
            settings.samples_per_pixel = 64;
            settings.max_depth = 12;
            check_against_naive(scene, 16, settings, 256);
        }
    }
}

// These tests compare each light effect of the rasterizer with the path tracer's value of the same quantity.
#include "common/scene/build_scene.h"
#include "compare/ladder/rungs.h"
#include "compare/metrics/error_metrics.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

using namespace duet;
using namespace duet::compare;

namespace {

Scene model(const std::string& name) {
    return load_scene(std::filesystem::path(DUET_SOURCE_DIR) / "models" / (name + ".json"));
}

raster::RasterSettings with_16_samples(const raster::LightComponentSet& parts) {
    raster::RasterSettings settings;
    settings.samples_per_pixel = 16;
    settings.components = parts;
    return settings;
}

ImageRgb traced(const Scene& scene, const View& view, raytrace::Integrator integrator, bool environment) {
    raytrace::PathTracerSettings settings;
    settings.integrator = integrator;
    settings.samples_per_pixel = 256;
    settings.environment = environment;
    Control control;
    return raytrace::render(raytrace::prepare(scene, settings), view, settings, control).radiance;
}

double error(const Scene& scene, const View& view, const raster::RasterSettings& settings, const ImageRgb& truth) {
    Control control;
    return error_metrics(raster::render(raster::prepare(scene, settings), view, settings, control).radiance, truth)
        .relmse;
}

View small(const Scene& scene, int width) { return {scene.camera, width, width * scene.height / scene.width}; }

} // namespace

// The bounds are well above the measured ratios. The seeds are fixed, so the results are deterministic.
TEST_SUITE("statistical") {

    TEST_CASE("shadows of the Cornell box: a fourteenth of the error of unshadowed light at most") {
        const Scene scene = model("cornell");
        const View view = small(scene, 96);
        const ImageRgb truth = traced(scene, view, raytrace::Integrator::kLights, false);
        raster::RasterSettings settings = with_16_samples(kLightsAlone);
        const double with = error(scene, view, settings, truth);
        settings.shadows = false;
        const double without = error(scene, view, settings, truth);
        MESSAGE("relmse ", with, ", unshadowed ", without);
        // Most of the remaining error is on the light's silhouette, where sample positions differ.
        CHECK(with < 0.07 * without); // measured: 0.059
    }

    TEST_CASE("shadows of sun, spot, point and surfaces with lens and motion: a tenth of the error at most") {
        const Scene scene = model("everything");
        const View view = small(scene, 96);
        const ImageRgb truth = traced(scene, view, raytrace::Integrator::kLights, false);
        raster::RasterSettings settings = with_16_samples(kLightsAlone);
        settings.environment = false;
        const double with = error(scene, view, settings, truth);
        settings.shadows = false;
        const double without = error(scene, view, settings, truth);
        MESSAGE("relmse ", with, ", unshadowed ", without);
        CHECK(with < 0.1 * without);
    }

    TEST_CASE("the environment's occlusion: a third of the error at most") {
        const Scene scene = model("spheres");
        const View view = small(scene, 128);
        const ImageRgb truth = traced(scene, view, raytrace::Integrator::kEnvironment, true);
        raster::RasterSettings settings = with_16_samples(kEnvironmentAlone);
        settings.indirect_light = false;
        const double with = error(scene, view, settings, truth);
        settings.ambient_occlusion = false;
        const double without = error(scene, view, settings, truth);
        MESSAGE("relmse ", with, ", without ", without);
        CHECK(with < without / 3);
    }

    TEST_CASE("reflections in spheres and refractions of glass are those of the path tracer, but for their "
              "approximations") {
        for (const auto& [name, bound] : {std::pair("spheres", 0.035), {"glass", 0.017}}) {
            const Scene scene = model(name);
            const View view = small(scene, 128);
            const ImageRgb truth = traced(scene, view, raytrace::Integrator::kReflection, true);
            Control control;
            const raster::RasterSettings settings = with_16_samples(kReflectionAlone);
            const double trimmed =
                error_metrics(raster::render(raster::prepare(scene, settings), view, settings, control).radiance, truth)
                    .relmse_trimmed;
            MESSAGE(std::string(name), ": relmse of all but the worst pixels ", trimmed);
            CHECK(trimmed < bound);
        }
    }

    TEST_CASE("area lights over rough metal: transformed cosines have the measured error") {
        Scene scene;
        const auto add = [&](Shape shape, Material material) {
            add_object(scene, "", std::move(shape), add_material(scene, "", std::move(material)));
        };
        add(QuadList{{{Vec3(-3, 0, 3), Vec3(6, 0, 0), Vec3(0, 0, -6)}}}, Metal{{Rgb(0.9f, 0.7f, 0.4f)}, 0.4f});
        add(QuadList{{{Vec3(-1, 1, -2), Vec3(2, 0, 0), Vec3(0, 1, 0)}}},
            Emissive{.radiance = Rgb(3.0f), .two_sided = true});
        add(Sphere{Vec3(1.5f, 0.7f, 0), 0.3f}, Emissive{Rgb(5.0f)});
        scene.camera.eye = {0, 2, 4};
        finish_scene(scene);
        const View view{scene.camera, 96, 72};
        const ImageRgb truth = traced(scene, view, raytrace::Integrator::kUnshadowed, false);
        raster::RasterSettings settings = with_16_samples(kLightsAlone);
        settings.shadows = false;
        const double found = error(scene, view, settings, truth);
        MESSAGE("relmse ", found);
        CHECK(found < 0.01);
    }

    // The worst pixel in a thousand is trimmed: in such small images a light's reflection covers one pixel or none.
    TEST_CASE("all effects together bring the image nearer to the path tracer's, in each scene") {
        const auto trimmed = [](const Scene& scene, const View& view, const raster::RasterSettings& settings,
                                const ImageRgb& truth) {
            Control control;
            const Rendering image = raster::render(raster::prepare(scene, settings), view, settings, control);
            return error_metrics(image.radiance, truth).relmse_trimmed;
        };
        for (const char* const name : {"cornell", "everything", "spheres"}) {
            const Scene scene = model(name);
            const View view = small(scene, 64);
            const ImageRgb truth = traced(scene, view, raytrace::Integrator::kPath, true);
            raster::RasterSettings settings = with_16_samples({});
            const double with = trimmed(scene, view, settings, truth);
            settings.shadows = settings.ambient_occlusion = settings.indirect_light = false;
            const double without = trimmed(scene, view, settings, truth);
            MESSAGE(std::string(name), ": relmse ", with, ", without ", without);
            CHECK(with < without);
        }
    }
}

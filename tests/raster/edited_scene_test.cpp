// These tests check prepare_edited(), with which an editor shows a scene before its probes are rendered.
#include "raster/raster_scene.h"
#include "raster/render.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raster;

namespace {

Scene scene_of(const char* name) {
    return load_scene(std::filesystem::path(DUET_SOURCE_DIR) / "models" / (std::string(name) + ".json"));
}

ImageRgb image(const RasterScene& prepared, const Scene& scene, const RasterSettings& settings) {
    Control control;
    return render(prepared, {scene.camera, 96, 72}, settings, control).radiance;
}

Scene with_first_object_moved(Scene scene) {
    scene.objects.front().place(Mat4(translation(Vec3d(0.05, 0.02, 0.1))));
    finish_scene(scene);
    return scene;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a scene that was not edited keeps its image, bit for bit") {
        for (const char* name : {"cornell", "spheres", "glass"}) {
            const Scene scene = scene_of(name);
            const RasterSettings settings;
            const RasterScene before = prepare(scene, settings);
            const auto edited = prepare_edited(scene, settings, before);
            REQUIRE(edited);
            CHECK(image(*edited, scene, settings).pixels() == image(before, scene, settings).pixels());
            CHECK(edited->data().irradiance_probes == before.data().irradiance_probes);
            CHECK(edited->data().reflection_probes == before.data().reflection_probes);
        }
    }

    TEST_CASE("an object that was moved stands and casts shadows where it is; light between surfaces lags behind") {
        const Scene scene = scene_of("cornell"), moved = with_first_object_moved(scene);
        RasterSettings settings;
        const auto edited = prepare_edited(moved, settings, prepare(scene, settings));
        REQUIRE(edited);
        const RasterScene whole = prepare(moved, settings);
        CHECK(image(*edited, moved, settings).pixels() != image(whole, moved, settings).pixels());
        settings.components = {.emission = true, .direct = true, .environment = false, .reflection = false};
        CHECK(image(*edited, moved, settings).pixels() == image(whole, moved, settings).pixels());
        CHECK(image(*edited, moved, settings).pixels() != image(prepare(scene, settings), scene, settings).pixels());
    }

    TEST_CASE("probes do not fit a scene with another number of objects, or whose objects reflect for the first time") {
        const Scene scene = scene_of("cornell");
        const RasterSettings settings;
        const RasterScene before = prepare(scene, settings);
        Scene fewer = scene;
        fewer.objects.pop_back();
        finish_scene(fewer);
        CHECK_FALSE(prepare_edited(fewer, settings, before));
        Scene shiny = scene;
        shiny.materials.push_back(Metal{});
        shiny.material_names.push_back("unused");
        finish_scene(shiny);
        const auto unused = prepare_edited(shiny, settings, before);
        REQUIRE(unused);
        CHECK(image(*unused, shiny, settings).pixels() == image(before, scene, settings).pixels());
        shiny.objects.front().materials.front() = static_cast<std::uint32_t>(shiny.materials.size()) - 1;
        finish_scene(shiny);
        CHECK_FALSE(prepare_edited(shiny, settings, before));
        CHECK_FALSE(prepare_edited(shiny, settings, *unused));
        RasterSettings direct;
        direct.indirect_light = false;
        CHECK_FALSE(prepare_edited(scene, direct, before));
    }
}

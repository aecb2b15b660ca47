// These tests check the images behind the window: in the end they are those of the programs, bit for bit.
#include "compare/view/live_view.h"

#include "common/scene/file_cache.h"
#include "common/system/error.h"
#include "common/system/file.h"
#include "raytrace/path_tracer_scene.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <chrono>

using namespace duet;
using namespace duet::compare;

namespace {

/// Waits for the images of a wish, as the window does: by showing it again and again.
void wait_for(LiveView& live, const Wish& wish) {
    while (!live.finished(wish)) {
        live.show(wish);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

Wish small_wish(const Scene& scene) {
    Wish wish{.version = 1, .view = {scene.camera, 48, 40}, .raster = {}, .raytrace = {}};
    wish.raytrace.samples_per_pixel = 5;
    return wish;
}

template <typename Prepared, typename Settings>
ImageRgb rendered(const Prepared& prepared, const View& view, const Settings& settings) {
    Control control;
    return render(prepared, view, settings, control).radiance;
}

void check_images(LiveView& live, const Scene& scene, const Wish& wish) {
    Scene seen = scene;
    seen.camera = wish.view.camera;
    seen.width = wish.view.width;
    seen.height = wish.view.height;
    CHECK(live.raster_frame()->rendering.radiance.pixels() ==
          rendered(prepare(seen, wish.raster), wish.view, wish.raster).pixels());
    CHECK(live.tracer_frame()->image.pixels() ==
          rendered(prepare(seen, wish.raytrace), wish.view, wish.raytrace).pixels());
}

const std::filesystem::path kCornell = std::filesystem::path(DUET_SOURCE_DIR) / "models" / "cornell.json";

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("both images become those of the programs, also after the camera has moved") {
        const Scene scene = load_scene(kCornell);
        Wish wish = small_wish(scene);
        std::atomic<int> news = 0;
        LiveView live(0, [&] { ++news; });
        CHECK_FALSE(live.finished(wish));
        live.load(wish.view, [&](Transforms) { return scene; });
        wait_for(live, wish);
        check_images(live, scene, wish);
        CHECK(live.tracer_frame()->samples == 5);
        CHECK(news >= 5); // the scene, a raster frame, a preview and at least two passes
        for (int step = 0; step < 20; ++step) {
            wish.view.camera.eye.x += 0.05;
            ++wish.version;
            live.show(wish);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        wait_for(live, wish);
        check_images(live, scene, wish);
    }

    TEST_CASE("an edit replaces the scene, and one that cannot be read leaves it") {
        const Scene scene = load_scene(kCornell);
        const Wish wish = small_wish(scene);
        LiveView live(0, [] {});
        live.load(wish.view, [&](Transforms) { return scene; });
        wait_for(live, wish);
        live.load(wish.view, [](Transforms) -> Scene { throw Error("no such scene"); });
        while (live.loaded().error.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        CHECK(live.loaded().error == "no such scene");
        check_images(live, scene, wish);
        Scene edited = scene;
        edited.environment = ConstantEnvironment{Rgb(0.5f)};
        finish_scene(edited);
        live.load(wish.view, [&](Transforms) { return edited; });
        while (!live.loaded().error.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        wait_for(live, wish);
        check_images(live, edited, wish);
    }

    TEST_CASE("an object that is moved is seen before the probes are rendered anew, and then as the programs show it") {
        const Scene scene = load_scene(kCornell);
        const Wish wish = small_wish(scene);
        LiveView live(0, [] {});
        live.load(wish.view, [&](Transforms) { return scene; });
        wait_for(live, wish);
        Scene edited = scene;
        bool seen_with_old_probes = false;
        for (int step = 1; step <= 10; ++step) {
            edited.objects.front().place(Mat4(translation(Vec3d(0.01 * step, 0, 0))));
            finish_scene(edited);
            const unsigned load = live.load(wish.view, [&](Transforms) { return edited; }, true);
            while (live.loaded().load != load || live.loaded().raster->load != load) {
                live.show(wish);
                std::this_thread::sleep_for(std::chrono::milliseconds(2));
            }
            seen_with_old_probes = seen_with_old_probes || !live.loaded().raster->whole;
            CHECK_FALSE(live.finished(wish));
        }
        CHECK(seen_with_old_probes);
        wait_for(live, wish);
        CHECK(live.loaded().raster->whole);
        check_images(live, edited, wish);
    }

    TEST_CASE("a dragged mesh keeps its hierarchy, and is at last as the programs show it") {
        const std::filesystem::path file = std::filesystem::path(DUET_SOURCE_DIR) / "models" / "amphora.json";
        const nlohmann::ordered_json json = nlohmann::ordered_json::parse(read_file(file));
        FileCache cache;
        const auto read = [&](double x) {
            nlohmann::ordered_json moved = json;
            moved["objects"][3]["transform"] = {{{"translate", {x, 0, 0}}}};
            return [&cache, &file, text = moved.dump()](Transforms t) { return parse_scene(file, text, cache, t); };
        };
        const auto hierarchy = [](const LoadedScene& loaded) {
            const std::uint32_t amphora = loaded.scene->objects[3].shape;
            REQUIRE(std::holds_alternative<Mesh>(loaded.scene->shapes[amphora]));
            return loaded.raytrace->prepared.data().accelerator.hierarchy(amphora);
        };
        const Wish wish = small_wish(read(0)(Transforms::kBaked));
        LiveView live(0, [] {});
        live.load(wish.view, read(0));
        wait_for(live, wish);
        CHECK_FALSE(hierarchy(live.loaded())); // all triangles are in the hierarchy of the world
        live.expect_edits(wish.view, read(0));
        std::shared_ptr<const raytrace::Bvh> own;
        for (int step = 1; step <= 5; ++step) {
            const unsigned load = live.load(wish.view, read(0.01 * step), true);
            while (live.loaded().load != load) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            const LoadedScene loaded = live.loaded();
            if (loaded.raytrace->whole) continue; // this machine is slow
            if (own) CHECK(hierarchy(loaded) == own);
            own = hierarchy(loaded);
        }
        CHECK(own);
        wait_for(live, wish);
        CHECK_FALSE(hierarchy(live.loaded()));
        check_images(live, read(0.05)(Transforms::kBaked), wish);
    }

    TEST_CASE("a paused path tracer renders nothing, and goes on where it was") {
        const Scene scene = load_scene(kCornell);
        Wish wish = small_wish(scene);
        LiveView live(0, [] {});
        live.pause(true);
        live.load(wish.view, [&](Transforms) { return scene; });
        while (!live.raster_frame()) {
            live.show(wish);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        CHECK_FALSE(live.tracer_frame());
        live.pause(false);
        wait_for(live, wish);
        check_images(live, scene, wish);
    }

    TEST_CASE("settings that cannot be rendered are reported with the image") {
        const Scene scene = load_scene(kCornell);
        Wish wish = small_wish(scene);
        wish.raytrace.samples_per_pixel = 1;
        wish.raytrace.sampler = SamplerKind::kStratified;
        LiveView live(0, [] {});
        live.load(wish.view, [&](Transforms) { return scene; });
        wait_for(live, wish);
        CHECK(live.tracer_frame()->error.find("progressive") != std::string::npos);
        CHECK(live.raster_frame()->error.empty());
    }
}

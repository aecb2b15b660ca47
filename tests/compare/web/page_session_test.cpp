// These tests drive a session of the web page as its JavaScript does, and check that both pipelines hold the same scene
// and render what the programs render.
#include "compare/web/page_session.h"

#include "common/system/file.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace duet;
using namespace duet::compare;
using Json = nlohmann::ordered_json;

namespace {

/// A copy of cornell.json with its meshes, in a folder of the test's own.
class Page {
public:
    Page() {
        const std::filesystem::path models = std::filesystem::path(DUET_SOURCE_DIR) / "models";
        std::filesystem::create_directories(folder_ / "meshes");
        for (const char* file : {"cornell.json", "meshes/cornell-tall.obj", "meshes/cornell-short.obj"})
            std::filesystem::copy_file(models / file, folder_ / file,
                                       std::filesystem::copy_options::overwrite_existing);
        both({{"do", "open"}, {"file", scene().string()}});
        both({{"do", "size"}, {"width", 48}, {"height", 40}});
    }
    ~Page() { std::filesystem::remove_all(folder_); }

    std::filesystem::path scene() const { return folder_ / "cornell.json"; }
    /// Carries out a command in both sessions, and returns the rasterizer's answer.
    Json both(const Json& command) {
        const Json answer = raster.call(command), other = traced.call(command);
        CHECK(answer == other);
        return answer;
    }

    PageSession raster{PageSession::Pipeline::kRaster}, traced{PageSession::Pipeline::kRaytrace};

private:
    std::filesystem::path folder_ = std::filesystem::path(DUET_BINARY_DIR) / "tests" / "scratch" / "page_session";
};

/// Renders until the path tracer's image has at least this many samples.
std::uint32_t trace(PageSession& session, std::uint32_t samples) {
    for (;;) {
        const Json answer = session.call({{"do", "trace"}, {"seconds", 0.0}});
        REQUIRE_FALSE(answer.contains("error"));
        if (answer["samples"] >= samples) return answer["samples"];
    }
}

/// The images of a saved scene, as the programs render them.
template <typename Settings> ImageRgb rendered(const std::filesystem::path& path, Settings settings) {
    Scene scene = load_scene(path);
    scene.width = 48;
    scene.height = 40;
    settings.threads = 1;
    Control control;
    return render(prepare(scene, settings), scene_view(scene), settings, control).radiance;
}

void check_images(Page& page) {
    REQUIRE_FALSE(page.both({{"do", "save"}}).contains("error"));
    REQUIRE_FALSE(page.raster.call({{"do", "raster"}}).contains("error"));
    raster::RasterSettings raster;
    raster.samples_per_pixel = 4;
    CHECK(page.raster.image().pixels() == rendered(page.scene(), raster).pixels());
    raytrace::PathTracerSettings raytrace;
    raytrace.aovs.variance = true;
    raytrace.samples_per_pixel = static_cast<int>(trace(page.traced, 3));
    CHECK(page.traced.image().pixels() == rendered(page.scene(), raytrace).pixels());
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("both pipelines show the scene after moves of the camera and of an object, and undo restores it") {
        Page page;
        const std::string file = read_file(page.scene(), 1 << 20);
        check_images(page);
        CHECK(read_file(page.scene(), 1 << 20) == file);
        CHECK(page.raster.call({{"do", "raster"}, {"rest", false}})["preview"] == false);

        page.both({{"do", "camera"}, {"orbit", {0.2, 0.1}}});
        page.both({{"do", "camera"}, {"dolly", 1.1}, {"commit", true}});
        const Json moved =
            page.both({{"do", "move"}, {"path", {"objects", "5"}}, {"right", 0.1}, {"up", 0}, {"pixel", {30.5, 30.5}}});
        CHECK(moved["changed"] == true);
        CHECK(page.raster.call({{"do", "raster"}, {"rest", false}, {"scale", 0.5}})["preview"] == true);
        check_images(page);
        CHECK(read_file(page.scene(), 1 << 20) != file);

        for (int step = 0; step < 2; ++step) CHECK_FALSE(page.both({{"do", "undo"}, {"back", true}}).contains("error"));
        CHECK(page.both({{"do", "undo"}, {"back", true}})["error"] == "nothing to undo");
        check_images(page);
        CHECK(read_file(page.scene(), 1 << 20) == file);
    }

    TEST_CASE(
        "elements are added, copied, turned, set and removed; an edit that makes no valid scene changes nothing") {
        Page page;
        const auto objects = [](const Json& state) { return state["scene"]["objects"].size(); };
        const std::size_t before = objects(page.both({{"do", "state"}}));
        const Json added = page.both({{"do", "add"}, {"what", "sphere"}});
        CHECK(objects(added) == before + 1);
        const Json path{"objects", std::to_string(before)};
        CHECK(objects(page.both({{"do", "duplicate"}, {"path", path}})) == before + 2);
        CHECK(page.both({{"do", "transform"}, {"path", path}, {"factor", 2}})["scene"]["objects"][before].contains(
            "transform"));
        const Json set =
            page.both({{"do", "set"}, {"path", {"objects", std::to_string(before), "radius"}}, {"value", 0.1}});
        CHECK(set["scene"]["objects"][before]["radius"] == 0.1);
        const Json refused =
            page.both({{"do", "set"}, {"path", {"objects", std::to_string(before), "radius"}}, {"value", "wide"}});
        CHECK(refused["error"].get<std::string>().find("radius") != std::string::npos);
        CHECK(page.both({{"do", "state"}})["scene"] == set["scene"]);
        CHECK(page.both({{"do", "undo"}, {"back", true}})["scene"] != set["scene"]);
        page.both(
            {{"do", "set"}, {"path", {"objects", "none"}}, {"value", 1}}); // a refused edit keeps what can be redone
        CHECK(page.both({{"do", "undo"}, {"back", false}})["scene"] == set["scene"]);
        CHECK(objects(page.both({{"do", "remove"}, {"path", path}})) == before + 1);
        CHECK(objects(page.both({{"do", "add"}, {"mesh", "meshes/cornell-short.obj"}})) == before + 2);
        CHECK(page.both({{"do", "add"}, {"mesh", "none.obj"}})["error"].get<std::string>().find("none.obj") !=
              std::string::npos);
        check_images(page);
    }

    TEST_CASE("a pixel is inspected, its object selected, and its path explained") {
        Page page;
        page.raster.call({{"do", "raster"}});
        trace(page.traced, 1);
        const Json command{{"do", "inspect"}, {"pixel", {30.5, 30.2}}};
        const Json r = page.raster.call(command), t = page.traced.call(command);
        CHECK(r["entry"] == t["entry"]);
        CHECK(r["material"] == "white");
        CHECK(t["hit"].get<std::string>().find("primitive") != std::string::npos);
        const Json path = page.traced.call({{"do", "path"}, {"pixel", {30.5, 30.2}}});
        CHECK(path["text"].get<std::string>().find("white") != std::string::npos);
    }

    TEST_CASE("the images are compared, shown in another way, and replaced by a quantity of the ladder") {
        Page page;
        page.raster.call({{"do", "raster"}});
        trace(page.traced, 1);
        page.traced.other_image() = page.raster.image();
        const Json difference = page.traced.call({{"do", "compare"}, {"show", "difference"}});
        CHECK(difference["figure"] > 0);
        page.traced.other_image() = page.traced.image();
        CHECK(page.traced.call({{"do", "compare"}, {"show", "FLIP"}})["figure"] == 0);
        page.traced.other_image() = ImageRgb(2, 2);
        CHECK(page.traced.call({{"do", "compare"}, {"show", "FLIP"}}).contains("error"));

        const std::vector<std::uint8_t> bytes = page.traced.bytes();
        page.both({{"do", "display"}, {"exposure", 2}, {"tone", "filmic"}});
        CHECK(page.traced.bytes() != bytes);

        CHECK(page.both({{"do", "choose"}, {"quantity", "beauty"}}).contains("error"));
        page.raster.call({{"do", "raster"}});
        const auto lit = page.raster.image().pixels();
        page.both({{"do", "choose"}, {"quantity", "albedo"}});
        page.raster.call({{"do", "raster"}});
        trace(page.traced, 16);
        const ImageRgb &r = page.raster.image(), &t = page.traced.image();
        std::size_t same = 0;
        for (std::size_t i = 0; i < r.size(); ++i)
            same += max(max_component(r[i] - t[i]), max_component(t[i] - r[i])) < 1e-5f;
        CHECK(same > r.size() / 2); // all but the pixels at edges
        page.both({{"do", "choose"}, {"quantity", "everything"}, {"shading", "flat"}});
        page.both({{"do", "size"}, {"width", 48}, {"height", 40}}); // prepares anew
        page.raster.call({{"do", "raster"}});
        CHECK(page.raster.image().pixels() != lit);
        page.both({{"do", "choose"}, {"shading", "lit"}});
        page.raster.call({{"do", "raster"}});
        CHECK(page.raster.image().pixels() == lit);
    }

    TEST_CASE("unknown and malformed commands are refused") {
        PageSession session(PageSession::Pipeline::kRaster);
        for (const Json& command : {Json{{"do", "dance"}}, Json{{"do", 1}}, Json(nullptr), Json{{"do", "raster"}},
                                    Json{{"do", "open"}, {"file", "no such file"}}, Json{{"do", "camera"}}})
            CHECK(session.call(command).contains("error"));
    }
}

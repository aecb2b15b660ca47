// These tests check a scene file that is edited: undo, saving, and what stays as it was typed.
#include "compare/view/document.h"

#include "common/system/error.h"
#include "common/system/file.h"
#include "compare/view/scene_text.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::compare;
using duet::test::ScratchFolder;

namespace {

const std::string kText = R"({
  "camera": {"eye": [0, 1, 6.80], "look_at": [0, 1, 0]},
  "materials": {"white": {"type": "diffuse", "albedo": 0.70}},
  "objects": [
    {"type": "sphere", "center": [0, 1, 0], "radius": 0.5, "material": "white"}
  ]
}
)";

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("steps are undone and done again, a new one discards what was undone") {
        const ScratchFolder folder;
        write_file(folder.path() / "scene.json", kText);
        SceneDocument document(folder.path() / "scene.json", {});
        CHECK_FALSE(document.changed());
        CHECK_FALSE(document.undo());
        for (const double radius : {0.6, 0.7}) // a drag: one step
            document.set_text(with_value(document.text(), {"objects", "0", "radius"}, radius));
        document.commit();
        Camera camera = document.camera();
        camera.eye.x = 2;
        document.set_camera(camera);
        document.commit();
        CHECK(document.changed());
        REQUIRE(document.undo());
        CHECK(document.camera().eye.x == 0);
        CHECK(document.json()["objects"][0]["radius"] == 0.7);
        REQUIRE(document.undo());
        CHECK(document.text() == kText);
        CHECK_FALSE(document.changed());
        CHECK_FALSE(document.undo());
        REQUIRE(document.redo());
        REQUIRE(document.redo());
        CHECK_FALSE(document.redo());
        CHECK(document.camera().eye.x == 2);
        document.undo();
        document.set_text(kText);
        CHECK_FALSE(document.redo());
    }

    TEST_CASE("a saved file differs in what was changed alone, and is the scene that was seen") {
        const ScratchFolder folder;
        const std::filesystem::path path = folder.path() / "scene.json";
        write_file(path, kText);
        SceneDocument document(path, {});
        Camera camera = document.camera();
        camera.eye = {1, 2.5, 3};
        camera.aperture_radius = 0.125;
        document.set_camera(camera);
        document.set_text(with_value(document.text(), {"objects", "0", "radius"}, 0.25));
        document.save();
        CHECK_FALSE(document.changed());
        std::string expected = kText;
        expected.replace(expected.find("[0, 1, 6.80]"), 12, "[1.0, 2.5, 3.0]");
        expected.replace(expected.find("[0, 1, 0]}"), 10, "[0, 1, 0], \"aperture_radius\": 0.125}");
        expected.replace(expected.find("0.5,"), 4, "0.25,");
        CHECK(read_file(path) == expected);
        const Scene scene = load_scene(path);
        CHECK(scene.camera.eye == camera.eye);
        CHECK(scene.camera.aperture_radius == camera.aperture_radius);
        document.undo();
        CHECK(document.changed()); // the file has what was undone
    }

    TEST_CASE("the reader makes the scene of the text, and reports what is wrong with it") {
        const ScratchFolder folder;
        const std::filesystem::path path = folder.path() / "scene.json";
        write_file(path, kText);
        SceneDocument document(path, {});
        CHECK(document.reader()(Transforms::kBaked).objects.size() == 1);
        CHECK(document.reader()(Transforms::kBaked).objects.size() == 1); // not only the scene that was read first
        document.set_text(without_value(document.text(), {"objects", "0"}));
        CHECK(document.reader()(Transforms::kBaked).objects.empty());
        document.set_text(with_value(kText, {"objects", "0", "radius"}, -1));
        CHECK_THROWS_AS(document.reader()(Transforms::kBaked), Error);
        write_file(path, "{");
        CHECK_THROWS_AS(document.reload(), Error);
        CHECK_THROWS_AS(SceneDocument(folder.path() / "none.json", {}), Error);
    }

    TEST_CASE("of a bare mesh the camera moves, and nothing can be saved") {
        const ScratchFolder folder;
        const std::filesystem::path path = folder.path() / "mesh.obj";
        write_file(path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        SceneDocument document(path, {});
        CHECK_FALSE(document.editable());
        document.set_camera({.eye = {1, 2, 3}});
        CHECK_FALSE(document.changed());
        CHECK_THROWS_AS(document.save(), Error);
        CHECK(document.reader()(Transforms::kBaked).objects.size() == 2);
    }
}

// These tests check how groups, instances and transforms are flattened.
#include "common/scene/scene.h"

#include "tests/support/errors.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

using namespace duet;
using duet::test::error_of;
using duet::test::says;
using duet::test::ScratchFolder;

namespace {

Scene load(const std::string& objects) {
    const ScratchFolder folder;
    return load_scene(folder.write(
        "scene.json",
        R"({"camera": {"eye": [0, 0, 50], "look_at": [0, 0, 0]}, "materials": {"m": {"type": "diffuse"}},
         "objects": )" +
            objects + "}"));
}
std::string refusal(const std::string& objects) {
    return error_of([&] { load(objects); });
}
const std::string kBall = R"({"name": "ball", "type": "sphere", "center": [1, 0, 0], "radius": 1, "material": "m"})";

std::vector<std::string> names(const Scene& scene) {
    std::vector<std::string> list;
    for (const Object& object : scene.objects) list.push_back(object.name);
    return list;
}

/// Returns the center of an object's sphere at a time.
Vec3 center(const Scene& scene, std::size_t object, float time = 0) {
    const Object& o = scene.objects[object];
    return transform_point(object_transform(o, time).to_world, std::get<Sphere>(scene.shapes[o.shape]).center);
}
void check_near(Vec3 a, Vec3 b) {
    CHECK_MESSAGE(length(a - b) < 1e-5f * (1 + length(b)),
                  message("(", a.x, ", ", a.y, ", ", a.z, "), expected (", b.x, ", ", b.y, ", ", b.z, ")"));
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("Steps are applied in order, groups around them last") {
        const Scene scene = load(
            R"([{"type": "group", "name": "g", "transform": [{"rotate_degrees": 90, "axis": [0, 0, 1]}], "objects": [
        {"type": "sphere", "center": [1, 0, 0], "radius": 1, "material": "m", "transform": [{"scale": 2},
         {"translate": [1, 0, 0]}]}]}])");
        REQUIRE(names(scene) == std::vector<std::string>{"g/sphere-0"});
        check_near(center(scene, 0), Vec3(0, 3, 0));
        CHECK(scene.objects[0].identity);
        CHECK(std::get<Sphere>(scene.shapes[0]).radius == doctest::Approx(2));
    }

    TEST_CASE("Instances share the shape, under the group's transform and their own") {
        const Scene scene = load(
            R"([{"type": "group", "name": "tree", "hidden": true, "transform": [{"translate": [0, 1, 0]}],
             "objects": [)" +
            kBall +
            R"(]}, {"type": "instance", "of": "tree", "transform": [{"scale": 10}]},
                {"type": "instance", "of": "tree", "name": "other", "transform": [{"rotate_degrees": -90, "axis": [0,
                 0, 5]}]}])");
        REQUIRE(names(scene) == std::vector<std::string>{"tree/ball", "other/ball"});
        CHECK(scene.shapes.size() == 1);
        check_near(center(scene, 0), Vec3(10, 10, 0));
        check_near(center(scene, 1), Vec3(1, -1, 0));
        CHECK_FALSE(scene.objects[0].identity);
        CHECK(scene.needs.instances);
    }

    TEST_CASE("A moving group moves its members, and an instance of it") {
        const Scene scene =
            load(R"([{"type": "group", "name": "g", "transform_end": [{"translate": [0, 4, 0]}], "objects": [)" +
                 kBall + R"(]}, {"type": "instance", "of": "g", "transform": [{"scale": 2}]}])");
        REQUIRE(scene.objects.size() == 2);
        CHECK(scene.objects[0].moving);
        check_near(center(scene, 0, 0.5f), Vec3(1, 2, 0));
        check_near(center(scene, 1, 0), Vec3(2, 0, 0));
        check_near(center(scene, 1, 1), Vec3(2, 8, 0));
        CHECK(scene.bounds.high.y >= 8 + 2);
    }

    TEST_CASE("Equal start and end are no motion") {
        const Scene scene = load(
            R"([{"type": "group", "transform": [{"scale": 2}], "transform_end": [{"scale": [2, 2, 2]}], "objects": [)" +
            kBall + "]}]");
        CHECK_FALSE(scene.objects[0].moving);
        CHECK_FALSE(scene.needs.motion);
    }

    TEST_CASE("Cycles, unknown groups and second definitions are refused") {
        struct {
            std::string objects, part;
        } const cases[] = {
            {R"([{"type": "group", "name": "a", "objects": [{"type": "instance", "of": "a"}]}])",
             "$.objects[0]: the group \"a\" is part of itself"},
            {R"([{"type": "group", "name": "a", "hidden": true, "objects": [{"type": "instance", "of": "b"}]},
             {"type": "group", "name": "b", "hidden": true, "objects": [{"type": "instance", "of": "a"}]}])",
             "is part of itself"},
            {R"([{"type": "group", "name": "a", "objects": [
                    {"type": "group", "name": "b", "objects": [{"type": "instance", "of": "a"}]}]}])",
             "is part of itself"},
            {R"([{"type": "group", "name": "tree", "objects": []}, {"type": "instance", "of": "tere"}])",
             "$.objects[1]: an instance of the unknown group \"tere\"; did you mean \"tree\"?"},
            {R"([{"type": "group", "name": "h", "hidden": true, "objects": [{"type": "instance", "of": "nothing"}]}])",
             "unknown group \"nothing\""},
            {R"([{"type": "group", "name": "a", "objects": []}, {"type": "group", "name": "a", "objects": []}])",
             "$.objects[1]: a second group of the name \"a\"; the first is $.objects[0]"},
            {R"([{"type": "group", "hidden": true, "objects": []}])", "a hidden group needs a \"name\""},
            {"[" + kBall + R"(, {"type": "instance", "of": "ball"}])", "unknown group \"ball\""},
        };
        for (const auto& example : cases) {
            const std::string error = refusal(example.objects);
            CAPTURE(error);
            CHECK(says(error, example.part));
        }
    }

    /// Returns groups g0 to g(levels − 1), each with two instances of the next. The last one holds `leaf`.
    std::string doubling(int levels, const std::string& leaf) {
        std::string objects = "[";
        for (int i = 0; i < levels; ++i) {
            const std::string next = message(R"({"type": "instance", "of": "g)", i + 1, "\"}");
            const std::string members = i + 1 < levels ? next + "," + next : leaf;
            objects += message(i > 0 ? "," : "", R"({"type": "group", "name": "g)", i, R"(", "hidden": )",
                               i > 0 ? "true" : "false", R"(, "objects": [)", members, "]}");
        }
        return objects + "]";
    }

    TEST_CASE("Doubling groups are expanded as far as is reasonable, and no farther") {
        CHECK(load(doubling(11, kBall)).objects.size() == 1024);
        CHECK(says(refusal(doubling(30, "")),
                   "expand to more than 10000000 objects")); // also if nothing is visible in the end
        CHECK(says(refusal(doubling(100, "")), "nested more than 64 deep"));
    }

    TEST_CASE("Nesting is limited") {
        const auto nested = [](int depth) {
            std::string text;
            for (int i = 0; i < depth; ++i) text += R"([{"type": "group", "objects": )";
            text += "[" + kBall + "]";
            for (int i = 0; i < depth; ++i) text += "}]";
            return text;
        };
        CHECK(load(nested(60)).objects.size() == 1);
        CHECK(says(refusal(nested(70)), "nested more than 64 deep"));
    }

    TEST_CASE("Transforms that only together are singular or too large are refused") {
        const std::string error = refusal(
            R"([{"type": "group", "transform": [{"scale": 1e12}], "objects": [
                    {"type": "group", "transform": [{"scale": 1e12}], "objects": [)" +
            kBall + "]}]}]");
        CHECK_MESSAGE(says(error, "$.objects[0].objects[0].objects[0]: together with the transforms around it, the "
                                  "transform or its inverse has entries beyond 1e18"),
                      error);
    }

    TEST_CASE("A mesh used often is read once") {
        const ScratchFolder folder;
        folder.write("meshes/t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        const Scene scene = load_scene(folder.write(
            "scene.json",
            R"({"camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}, "materials": {"m": {"type": "diffuse"}},
        "objects": [{"type": "mesh", "file": "meshes/t.obj"},
                    {"type": "mesh", "file": "meshes/../meshes/t.obj", "transform": [{"translate": [1, 0, 0]}]},
                    {"type": "mesh", "file": "meshes/t.obj", "material": "m"},
                    {"type": "mesh", "file": "meshes/t.obj", "normals": "smooth"}]})"));
        CHECK(scene.objects[0].shape == scene.objects[1].shape);
        CHECK(scene.objects[2].materials == std::vector<std::uint32_t>{0});
        CHECK(scene.material_names[scene.objects[0].materials[0]] == "t:default");
        CHECK(std::get<Mesh>(scene.shapes[scene.objects[3].shape]).normals.size() == 3);
        CHECK(std::get<Mesh>(scene.shapes[scene.objects[0].shape]).normals.empty());
    }

} // TEST_SUITE

// These tests check the edits that the window offers, by what the edited scenes hold.
#include "compare/view/edits.h"

#include "common/scene/motion_bounds.h"
#include "common/system/error.h"
#include "common/system/file.h"
#include "compare/view/inspect.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace duet;
using namespace duet::compare;

namespace {

const std::filesystem::path kPath = std::filesystem::path(DUET_SOURCE_DIR) / "models" / "edited.json"; // never written

const std::string kText = R"({
  "camera": {"eye": [0, 1, 6], "look_at": [0, 1, 0]},
  "materials": {"white": {"type": "diffuse", "albedo": 0.7}},
  "objects": [
    {"type": "sphere", "center": [0, 1, 0], "radius": 0.5, "material": "white"},
    {"type": "box", "low": [1, 0, 0], "high": [2, 1, 1], "material": "white"},
    {"type": "quad", "corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "material": "white"},
    {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "white", "transform": [{"scale": 2}]},
    {"type": "group", "objects": [{"type": "sphere", "center": [5, 0, 0], "radius": 1, "material": "white"}],
     "transform": [{"translate": [0, 1, 0]}], "transform_end": [{"translate": [0, 2, 0]}]}
  ],
  "lights": [
    {"type": "point", "position": [0, 3, 0], "intensity": 5},
    {"type": "sun", "direction": [0, -1, 0], "irradiance": 2}
  ]
})";

Box3 bounds_of(const std::string& text, std::uint32_t entry) {
    return entry_bounds(parse_scene(kPath, text), entry);
}

void check_near(Vec3 a, Vec3 b) { CHECK(length(a - b) < 1e-5f); }

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("every kind of object moves by the vector, and nothing else changes") {
        const Vec3d by(0.25, -0.5, 2);
        for (std::uint32_t entry = 0; entry < 5; ++entry) {
            CAPTURE(entry);
            const std::string text =
                moved(moved(kText, {"objects", std::to_string(entry)}, by), {"objects", std::to_string(entry)},
                      by); // the second goes to the same numbers
            for (std::uint32_t other = 0; other < 5; ++other) {
                const Box3 before = bounds_of(kText, other), after = bounds_of(text, other);
                const Vec3 shift = other == entry ? Vec3(2.0 * by) : Vec3();
                check_near(after.low, before.low + shift);
                check_near(after.high, before.high + shift);
            }
        }
        CHECK(moved(kText, {"objects", "0"}, by).size() < kText.size() + 12); // no transform was added
    }

    TEST_CASE("maps are applied after the object's own transform, and collect in one matrix") {
        const Mat4d turn = rotation(Vec3d(0, 0, 1), radians(90.0));
        const std::string once = transformed(kText, {"objects", "1"}, turn);
        const Box3 box = bounds_of(once, 1); // (1..2, 0..1) becomes (−1..0, 1..2)
        check_near(box.low, {-1, 1, 0});
        check_near(box.high, {0, 2, 1});
        const std::string twice = transformed(once, {"objects", "1"}, turn);
        CHECK(nlohmann::json::parse(twice)["objects"][1]["transform"].size() == 1);
        check_near(bounds_of(twice, 1).low, {-2, -1, 0});
        const Box3 scaled = bounds_of(transformed(kText, {"objects", "3"}, scaling(Vec3d(3, 1, 1))), 3);
        CHECK(scaled.high.x == doctest::Approx(6));
        CHECK(scaled.high.y == doctest::Approx(2));
    }

    TEST_CASE("lights and media move, turn and scale as far as they can") {
        const nlohmann::ordered_json own = nlohmann::ordered_json::parse(R"({"lights": [
            {"type": "spot", "position": [1, 2, 3], "direction": [0, -2, 0], "intensity": 1},
            {"type": "sun", "direction": [0, -1, 0], "irradiance": 2}],
            "media": [{"type": "fog", "low": [0, 0, 0], "high": [2, 2, 2], "scattering": 1},
                      {"type": "fog", "scattering": 0.1}, {"type": "fog", "low": [0, 0, 0], "scattering": 0.1}]})");
        const std::string text = own.dump();
        const JsonPath spot{"lights", "0"}, sun{"lights", "1"}, box{"media", "0"}, everywhere{"media", "1"};
        const JsonPath above{"media", "2"};
        const auto edited = [](const std::string& changed) { return nlohmann::ordered_json::parse(changed); };
        using Numbers = std::vector<double>;

        CHECK(edited(moved(text, spot, {1, 0, -1}))["lights"][0]["position"] == Numbers{2, 2, 2});
        CHECK(edited(moved(text, box, {1, 0, -1}))["media"][0]["high"] == Numbers{3, 2, 1});
        CHECK(moved(text, sun, {1, 0, -1}) == text);
        CHECK(moved(text, everywhere, {1, 0, -1}) == text);

        const Mat4d turn = rotation(Vec3d(0, 0, 1), radians(90.0)); // (x, y, z) becomes (−y, x, z)
        const auto turned = edited(transformed(text, spot, turn))["lights"][0];
        CHECK(turned["position"] == Numbers{-2, 1, 3});
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(turned["direction"][i].get<double>() == doctest::Approx(i == 0 ? 2 : 0));
        CHECK(edited(transformed(text, sun, turn))["lights"][1]["direction"][0].get<double>() == doctest::Approx(1));
        const auto scaled = edited(transformed(text, box, scaling(Vec3d(3, 3, 3))))["media"][0];
        const std::string nowhere = with_value(text, {"lights", "1", "direction"}, Numbers{0, 0, 0});
        CHECK_THROWS_AS(transformed(nowhere, sun, turn), Error);
        CHECK(scaled["low"] == Numbers{0, 0, 0});
        CHECK(scaled["high"] == Numbers{6, 6, 6});

        const auto able = [&](const JsonPath& path) {
            const Handles h = handles(own, path);
            return std::array{h.move, h.turn, h.scale};
        };
        CHECK(able(spot) == std::array{true, true, false});
        CHECK(able(sun) == std::array{false, true, false});
        CHECK(able(box) == std::array{true, false, true});
        CHECK(able(everywhere) == std::array{false, false, false});
        CHECK(able(above) == std::array{false, false, false});
        CHECK(place(own, above).empty());
        CHECK(place(own, spot).low == Vec3(1, 2, 3));
        CHECK(place(own, box).high == Vec3(2, 2, 2));
        CHECK(place(own, sun).empty());
        CHECK(place(own, everywhere).empty());
    }

    TEST_CASE("an object's own axes follow its transform, and stay orthonormal") {
        const nlohmann::ordered_json scene = nlohmann::ordered_json::parse(R"({"objects": [{"type": "box"},
            {"type": "box", "transform": [{"scale": [2, 3, 4]}, {"rotate_degrees": 90, "axis": [0, 0, 1]},
                                          {"translate": [5, 6, 7]}]},
            {"type": "box", "transform": [{"matrix": [1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]}]})");
        const auto axes = [&](const char* index) { return local_axes(scene, {"objects", index}); };
        const Vec3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
        CHECK(axes("0") == std::array{x, y, z});
        const std::array expected{y, -x, z};
        for (std::size_t i = 0; i < 3; ++i) CHECK(length(axes("1")[i] - expected[i]) < 1e-12);
        for (std::size_t i = 0; i < 3; ++i) // a shear moves the y axis alone
            CHECK(length(axes("2")[i] - std::array{x, y, z}[i]) < 1e-12);
    }

    TEST_CASE("a material of its own looks the same, and no other object has it") {
        const std::string once = with_own_material(kText, {"objects", "1"});
        const auto scene = nlohmann::json::parse(with_own_material(once, {"objects", "2"}));
        CHECK(scene["objects"][0]["material"] == "white");
        CHECK(scene["objects"][1]["material"] == "white 2");
        CHECK(scene["objects"][2]["material"] == "white 3");
        for (const char* name : {"white", "white 2", "white 3"}) CHECK(scene["materials"][name]["albedo"] == 0.7);
        CHECK(bounds_of(once, 1).low == bounds_of(kText, 1).low);
    }

    TEST_CASE("a copy is the same object once more") {
        const std::string text = duplicated(kText, {"objects", "1"});
        CHECK(bounds_of(text, 5).low == bounds_of(kText, 1).low);
        CHECK(parse_scene(kPath, text).objects.size() == 6);
        const std::string named = with_value(kText, {"objects", "4", "name"}, "a group");
        CHECK(parse_scene(kPath, duplicated(named, {"objects", "4"})).objects.size() == 6);
    }

    TEST_CASE("new elements are where they shall be, in every scene") {
        const std::string bare = R"({"camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}, "objects": []})";
        for (const std::string& text : {kText, bare})
            for (std::size_t i = 0; i < kNewElementNames.size(); ++i) {
                CAPTURE(kNewElementNames[i]);
                const Scene before = parse_scene(kPath, text);
                const auto element = static_cast<NewElement>(i);
                const Scene scene = parse_scene(kPath, with_new_element(text, element, {1, 2, 3}, 0.5));
                if (element == NewElement::kPointLight) {
                    const auto* light = std::get_if<PointLight>(&scene.lights[scene.first_surface_light - 1]);
                    REQUIRE(light != nullptr);
                    check_near(light->position, {1, 2, 3});
                    continue;
                }
                if (element == NewElement::kCloud) {
                    const Medium& cloud = scene.media.back();
                    CHECK(cloud.density != nullptr);
                    check_near((cloud.box.low + cloud.box.high) / 2.0f, {1, 2, 3});
                    continue;
                }
                REQUIRE(scene.objects.size() == before.objects.size() + 1);
                const Object& object = scene.objects.back();
                const Box3 box = motion_bounds(object, scene.shapes[object.shape]);
                check_near((box.low + box.high) / 2.0f, {1, 2, 3});
                CHECK(box.high.x - box.low.x == doctest::Approx(0.5));
                CHECK((scene.lights.size() > before.lights.size()) == (element == NewElement::kAreaLight));
            }
    }

    TEST_CASE("a typed number holds seven digits") {
        CHECK(typed_number(0.1f) == 0.1);
        CHECK(typed_number(-1234567.89) == -1234568);
        CHECK(typed_number(1.0 / 3) == 0.3333333);
        CHECK(typed_number(0) == 0);
    }

    TEST_CASE("a copy of groups has names of its own, and its instances show its own groups") {
        const std::string text = R"({
  "camera": {"eye": [0, 1, 6], "look_at": [0, 1, 0]},
  "materials": {"white": {"type": "diffuse", "albedo": 0.7}},
  "objects": [
    {"type": "group", "name": "all", "objects": [
      {"type": "group", "name": "ball", "hidden": true, "objects": [
        {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "white"}]},
      {"type": "instance", "of": "ball", "transform": [{"translate": [3, 0, 0]}]}]},
    {"type": "group", "name": "ball 2", "objects": [
      {"type": "sphere", "center": [9, 0, 0], "radius": 1, "material": "white"}]}
  ]
})";
        const nlohmann::json scene = nlohmann::json::parse(duplicated(text, {"objects", "0"}));
        const nlohmann::json& copy = scene.at("objects").at(2);
        CHECK(copy.at("name") == "all 2");
        CHECK(copy.at("objects").at(0).at("name") == "ball 3");
        CHECK(copy.at("objects").at(1).at("of") == "ball 3");
        CHECK(parse_scene(kPath, scene.dump()).objects.size() == parse_scene(kPath, text).objects.size() + 1);
    }
}

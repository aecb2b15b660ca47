// These tests check edits of the text of a scene file: what an edit does not touch stays as it was typed.
#include "compare/view/scene_text.h"

#include "common/system/error.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace duet;
using namespace duet::compare;
using nlohmann::ordered_json;

namespace {

const std::string kText = R"({
  "camera": {"eye": [0, 1, 6.80], "fov_degrees": 19.5},
  "materials": {
    "a/b": {"type": "diffuse", "albedo": 0.5},
    "say \"}\"": {"type":"diffuse","albedo":[ 1.0,0.5, 0.25e0 ]}
  },
  "objects": [
    {"name": "floor, {wide}", "radius": 1},
    {"name": "wall"}
  ],
  "lights": []
}
)";

std::string valid(std::string text) {
    CHECK(ordered_json::accept(text));
    return text;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a value is found by its keys, also behind strings that hold brackets and quotes") {
        CHECK(value_text(kText, {"camera", "eye"}) == "[0, 1, 6.80]");
        CHECK(value_text(kText, {"camera", "eye", "2"}) == "6.80");
        CHECK(value_text(kText, {"materials", "a/b", "albedo"}) == "0.5");
        CHECK(value_text(kText, {"materials", "say \"}\"", "albedo", "2"}) == "0.25e0");
        CHECK(value_text(kText, {"objects", "1"}) == R"({"name": "wall"})");
        CHECK(value_text(kText, {"lights"}) == "[]");
        CHECK_THROWS_AS(value_text(kText, {"objects", "2"}), Error);
        CHECK_THROWS_AS(value_text(kText, {"camera", "up"}), Error);
        CHECK_THROWS_AS(value_text(kText, {"camera", "fov_degrees", "x"}), Error);
        CHECK_THROWS_AS(value_text(kText, {}), Error);
    }

    TEST_CASE("a changed value is the only part of the text that changes") {
        const std::string changed = with_value(kText, {"camera", "eye", "1"}, 2.5);
        std::string expected = kText;
        expected.replace(expected.find("[0, 1, 6.80]"), 12, "[0, 2.5, 6.80]");
        CHECK(changed == expected);
    }

    TEST_CASE("a new value is set off as its neighbors are") {
        const std::string small = "{\n  \"a\": [\n    1,\n    2\n  ],\n  \"b\": {\"c\": 3}\n}\n";
        CHECK(valid(with_value(small, {"a", "2"}, 3)) ==
              "{\n  \"a\": [\n    1,\n    2,\n    3\n  ],\n  \"b\": {\"c\": 3}\n}\n");
        CHECK(valid(with_value(small, {"b", "d"}, true)) ==
              "{\n  \"a\": [\n    1,\n    2\n  ],\n  \"b\": {\"c\": 3, \"d\": true}\n}\n");
        CHECK(valid(with_value(small, {"e"}, "x")) ==
              "{\n  \"a\": [\n    1,\n    2\n  ],\n  \"b\": {\"c\": 3},\n  \"e\": \"x\"\n}\n");
        CHECK(with_value("{}", {"e"}, nullptr) == "{\"e\": null}");
        CHECK(with_value("{\"e\": [ ]}", {"e", "0"}, 1) == "{\"e\": [1]}");
        CHECK(with_value("[1,2]", {"2"}, 3) == "[1,2,3]");
        CHECK_THROWS_AS(with_value(small, {"a", "0", "x"}, 1), Error);
        CHECK(valid(with_value("[1 , 2]", {"2"}, 3)) == "[1 , 2, 3]");
        CHECK(valid(with_value("{\r\n  \"a\": 1\r\n, \"b\": 2\r\n}", {"c"}, 3)) ==
              "{\r\n  \"a\": 1\r\n, \"b\": 2, \"c\": 3\r\n}");
        CHECK(with_value("\xEF\xBB\xBF{\"a\": 1}", {"a"}, 2) == "\xEF\xBB\xBF{\"a\": 2}"); // a byte order mark
    }

    TEST_CASE("a removed value takes its comma with it") {
        const std::string small = "{\n  \"a\": [1, 2, 3],\n  \"b\": 4,\n  \"c\": 5\n}\n";
        CHECK(valid(without_value(small, {"a", "0"})) == "{\n  \"a\": [2, 3],\n  \"b\": 4,\n  \"c\": 5\n}\n");
        CHECK(valid(without_value(small, {"a", "1"})) == "{\n  \"a\": [1, 3],\n  \"b\": 4,\n  \"c\": 5\n}\n");
        CHECK(valid(without_value(small, {"a", "2"})) == "{\n  \"a\": [1, 2],\n  \"b\": 4,\n  \"c\": 5\n}\n");
        CHECK(valid(without_value(small, {"b"})) == "{\n  \"a\": [1, 2, 3],\n  \"c\": 5\n}\n");
        CHECK(valid(without_value(small, {"c"})) == "{\n  \"a\": [1, 2, 3],\n  \"b\": 4\n}\n");
        CHECK(valid(without_value("{\"a\": 1}", {"a"})) == "{}");
        CHECK_THROWS_AS(without_value(small, {"d"}), Error);
    }

    TEST_CASE("values are written as people type them") {
        const ordered_json value{{"center", {0, 1.5, -2}}, {"name", "a \"b\""}, {"list", ordered_json::array()}};
        CHECK(typed_json(value) == R"({"center": [0, 1.5, -2], "name": "a \"b\"", "list": []})");
        CHECK(ordered_json::parse(typed_json(value)) == value);
    }
}

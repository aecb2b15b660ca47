#include "common/scene/json/json_reader.h"
#include "common/system/suggestion.h"

#include "tests/support/errors.h"

#include <doctest/doctest.h>

using namespace duet;
using duet::test::error_of;
using duet::test::says;

namespace {

const std::filesystem::path kFile = "some.json";

std::string parse_error(const std::string& text) {
    return error_of([&] { parse_json(kFile, text); });
}

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("A text becomes a tree, keys in the file's order") {
        const JsonNode root = parse_json(kFile, R"({"b": [1, -2.5e3, true, null, "x\u00e9"], "a": {}})");
        REQUIRE(root.keys == std::vector<std::string>{"b", "a"});
        const JsonNode& list = root.items[0];
        REQUIRE(list.items.size() == 5);
        CHECK(list.items[0].number == 1);
        CHECK(list.items[1].number == -2500);
        CHECK(list.items[2].boolean);
        CHECK(list.items[3].kind == JsonNode::Kind::kNull);
        CHECK(list.items[4].text == "x\xc3\xa9");
        CHECK(root.items[1].kind == JsonNode::Kind::kObject);
    }

    TEST_CASE("Syntax errors name line and column, on one line") {
        struct {
            std::string text, part;
        } const cases[] = {
            {"", "some.json: line 1, column 1: "},
            {"{\"a\": 1,\n  \"b\" 2}", "line 2, column 7: "},
            {"[1, 2", "line 1, column 6: "},
            {"[1e999]", "number overflow"},
            {"[-1e999]", "number overflow"},
            {"[NaN]", "line 1, column 2: "},
            {"[Infinity]", "line 1, column 2: "},
            {"[1] x", "line 1, column 5: "},
            {"{\"a\": 1, \"b\": 2, \"a\": 3}", "some.json: $: the key \"a\" is given twice"},
            {"{\"x\": [0, {\"y\": {\"a\": 1, \"a\": 1}}]}", "some.json: $.x[1].y: the key \"a\" is given twice"},
            {std::string("[\"\xff\xfe\"]"), "line 1"},
            {std::string("\x89PNG\r\n\x1a\n\0\0\0", 11), "line 1, column 1"},
            {"[\"a\nb\"]", "line 1"},
            {"[01]", "line 1, column 3"},
            {"{'a': 1}", "line 1, column 2"},
        };
        for (const auto& example : cases) {
            const std::string error = parse_error(example.text);
            CAPTURE(example.text);
            CAPTURE(error);
            CHECK(says(error, example.part));
        }
    }

    TEST_CASE("Deep nesting is refused before it can overflow a stack") {
        CHECK(says(parse_error(repeated("[", 100'000)), "nested more than 256 deep"));
        CHECK(says(parse_error(repeated("{\"a\":", 100'000)), "nested more than 256 deep"));
        CHECK(parse_error(repeated("[", 256) + repeated("]", 256)) == "no error");
        CHECK(says(parse_error(repeated("[", 257) + repeated("]", 257)), "nested more than 256 deep"));
    }

    TEST_CASE("Values say where they stand, what they are and what they should be") {
        const JsonNode root = parse_json(
            kFile, R"({"list": [{"x": "big"}], "v": [1, 2], "n": 5, "odd key!": 1, "t": "", "c": [0.1, 2, 0.3]})");
        const JsonValue value(root, kFile);
        const auto fails = [](const auto& call, const std::string& expected) {
            const std::string error = error_of(call);
            CHECK_MESSAGE(error == expected, error);
        };
        fails([&] { value.at("list").elements()[0].at("x").number(); },
              "some.json: $.list[0].x: found the string \"big\", expected a number");
        fails([&] { value.at("v").vec3(); },
              "some.json: $.v: found an array of 2 elements, expected an array of 3 numbers");
        fails([&] { value.at("n").number(kUnit); }, "some.json: $.n: found 5, expected a number in [0, 1]");
        fails([&] { value.at("n").integer(0, 4); }, "some.json: $.n: found 5, expected a whole number in [0, 4]");
        fails([&] { value.at("n").boolean(); }, "some.json: $.n: found 5, expected true or false");
        fails([&] { value.at("t").string(); },
              "some.json: $.t: found the string \"\", expected a string that is not empty");
        fails([&] { value.at("c").rgb(); }, "some.json: $.c[1]: found 2, expected a number in [0, 1]");
        fails([&] { value.at("n").elements(); }, "some.json: $.n: found 5, expected an array");
        fails([&] { value.at("odd key!").string(); }, "some.json: $[\"odd key!\"]: found 1, expected a string");
        fails([&] { value.at("gone"); }, "some.json: $: the key \"gone\" is missing");
        CHECK(value.at("n").rgb({0, 10}) == Rgb(5.0f));
        CHECK(value.number_or("n", 7) == 5);
        CHECK(value.number_or("m", 7) == 7);
    }

    TEST_CASE("A positive number that is 0 as a float is not positive") {
        const JsonNode root = parse_json(kFile, "[1e-60, 1e-30]");
        const JsonValue value(root, kFile);
        CHECK(says(error_of([&] { value.elements()[0].number(kPositive); }), "found 1e-60, expected a number above 0"));
        CHECK(value.elements()[1].number(kPositive) == 1e-30);
    }

    TEST_CASE("The nearest key is suggested, and none where none is near") {
        const std::vector<std::string_view> known{"albedo", "radiance", "roughness", "type"};
        CHECK(suggestion("albdeo", known) == "; did you mean \"albedo\"?");
        CHECK(suggestion("w", {"x", "y", "z"}).empty()); // no letter would be left
        CHECK(suggestion("Roughness", known) == "; did you mean \"roughness\"?");
        CHECK(suggestion("elephant", known).empty());
        CHECK(suggestion(std::string(100'000, 'a'), known).empty());
    }

    TEST_CASE("Foreign text in a message stays on its line") {
        CHECK(quoted_text("a\nb\x01\xff") == "\"a\\x0ab\\x01\\xff\"");
        CHECK(quoted_text(std::string(1000, 'x')).size() < 80);
    }

} // TEST_SUITE

// These tests check the random scenes of `compare stress --only scenes`: what is drawn, how it is judged, and how a
// failing scene is reduced.
#include "common/scene/scene.h"
#include "common/system/error.h"
#include "common/system/file.h"
#include "compare/stress/scenes/reduce_scene.h"
#include "compare/stress/scenes/scene_checker.h"
#include "compare/stress/scenes/scene_files.h"
#include "compare/stress/scenes/schema_values.h"

#include "tests/support/errors.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace duet;
using namespace duet::compare;
using duet::test::error_of;
using duet::test::ScratchFolder;

namespace {

const Json& scene_schema() {
    static const Json schema =
        Json::parse(read_file(std::filesystem::path(DUET_SOURCE_DIR) / "models" / "scene.schema.json"));
    return schema;
}

/// Returns whether an object has all keys that a definition requires, and no others than it allows.
bool fits(const Json& object, const Json& definition) {
    const Json properties = definition.value("properties", Json::object());
    for (const auto& [key, item] : object.items())
        if (!properties.contains(key) || properties[key].value("const", item) != item) return false;
    const Json required = definition.value("required", Json::array());
    return std::all_of(required.begin(), required.end(),
                       [&](const Json& key) { return object.contains(key.get<std::string>()); });
}

/// Adds all keys of a value, each as the definition that its object fits and the key: "sphere.radius".
void collect_keys(const Json& value, std::set<std::string>& keys) {
    if (value.is_object())
        for (const auto& [name, definition] : scene_schema()["$defs"].items())
            if (fits(value, definition))
                for (const auto& [key, item] : value.items()) keys.insert(name + '.' + key);
    for (const auto& item : value)
        if (item.is_structured()) collect_keys(item, keys);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("random scenes: almost all can be loaded, and every key of the format comes up") {
        const ScratchFolder folder;
        const auto files = write_scene_files(folder.path());
        std::set<std::string> keys;
        int loaded = 0;
        constexpr int kScenes = 300;
        for (std::uint64_t i = 0; i < kScenes; ++i) {
            TrialRandom random(mix_bits(i + 1));
            const Json scene = SchemaValues(scene_schema(), files, {}, random).scene();
            collect_keys(scene, keys);
            write_file(folder.path() / "scene.json", scene.dump());
            const std::string error = error_of([&] { load_scene(folder / "scene.json"); });
            loaded += error == "no error";
        }
        CHECK(loaded >= 249); // measured: 268; four standard errors of 9/10 below 270
        for (const auto& definition : scene_schema()["$defs"].items()) {
            const Json properties = definition.value().value("properties", Json::object());
            for (const auto& property : properties.items()) {
                const std::string key = definition.key() + '.' + property.key();
                CHECK_MESSAGE(keys.contains(key), key);
            }
        }
    }

    TEST_CASE("random scenes: a seed gives the same scene; sizes move and scale it") {
        const std::map<std::string, std::vector<std::string>> files = {
            {"mesh", {"a.obj"}}, {"image_texture", {"a.png"}}, {"image_environment", {"a.hdr"}}, {"smoke", {"a.raw"}}};
        const auto scene = [&](std::uint64_t seed, const SceneSizes& sizes) {
            TrialRandom random(seed);
            return SchemaValues(scene_schema(), files, sizes, random).scene();
        };
        CHECK(scene(1, {}) == scene(1, {}));
        CHECK(scene(1, {}) != scene(2, {}));
        const Json far = scene(1, {.unit = 1e-3, .middle = {1e3, 0, -1e3}});
        for (std::size_t axis = 0; axis < 3; ++axis)
            CHECK(std::abs(far["camera"]["eye"][axis].get<double>() - std::array{1e3, 0.0, -1e3}[axis]) < 0.01);
    }

    TEST_CASE("random scenes: a schema with an unknown keyword is refused, not ignored") {
        const std::pair<const char*, const char*> unknown[] = {
            {R"({"oneOf": [{"const": 1}]})", "oneOf"},
            {R"({"type": "number", "multipleOf": 2})", "expected no multipleOf beside number"},
            {R"({"anyOf": [{"type": "boolean"}], "not": {"const": true}})", "expected no not beside anyOf"},
            {R"({"type": "object", "properties": {"a": {"type": "string", "pattern": "a"}}, "required": ["a"]})",
             "expected no pattern beside string"}};
        for (const auto& refused : unknown) {
            const Json schema = Json::parse(refused.first);
            TrialRandom random(1);
            const std::string error = error_of([&] { SchemaValues(schema, {}, {}, random).scene(); });
            CHECK_MESSAGE(error.find(refused.second) != std::string::npos, error);
            CHECK(error.find("expected") != std::string::npos);
        }
    }

    TEST_CASE("reduction: what the failure needs stays, with few digits, and nothing else") {
        const Json scene = Json::parse(R"({"camera": {"eye": [0, 0, 5]},
            "objects": [{"type": "box"}, {"type": "group", "objects": [{"type": "sphere", "radius": 2.345678},
                        {"type": "sphere", "radius": 0.5}]}]})");
        int calls = 0;
        const auto has_large_sphere = [&](const Json& part) {
            ++calls;
            for (const Json& object : part.value("objects", Json::array()))
                for (const Json& inner : object.value("objects", Json::array()))
                    if (inner.value("radius", 0.0) > 2) return true;
            return false;
        };
        const Json least = Json::parse(R"({"objects": [{"objects": [{"radius": 2.3}]}]})");
        CHECK(reduce_scene(scene, 60, has_large_sphere) == least);
        CHECK(calls > 0);
        calls = 0;
        CHECK(reduce_scene(scene, 0, has_large_sphere) == scene); // no time
        CHECK(calls == 0);
    }

    TEST_CASE("the checker: verdicts, crashes and hangs, each with what the process said") {
        const char* const script = R"(while read -r name; do case $name in
            good) echo '{"verdict": "ok", "failure": "", "details": ""}';;
            bad) echo noise; echo '{"verdict": "failed", "failure": "invalid samples", "details": "3 of 4"}';;
            refused) echo '{"verdict": "refused", "details": "no camera"}';;
            crash) echo overflow; exit 1;;
            wait) exec sleep 100;;
            loop) while :; do :; done;; esac; done)";
        using namespace std::chrono_literals;
        SceneChecker checker({"sh", "-c", script}, {.processor = 1s, .waiting = 60s});
        CHECK_FALSE(checker.check("good").failed());
        const SceneVerdict bad = checker.check("bad"), refused = checker.check("refused");
        CHECK(bad.failure == "invalid samples");
        CHECK(bad.details == "3 of 4");
        CHECK(refused.refused);
        CHECK_FALSE(refused.failed());
        CHECK(refused.details == "no camera");
        const SceneVerdict crash = checker.check("crash");
        CHECK(crash.failure == "crash");
        CHECK(crash.details == "overflow");
        CHECK(checker.check("loop").failure == "hang");
        CHECK_FALSE(checker.check("good").failed()); // by a new process
        CHECK(SceneChecker({"sh", "-c", script}, {.processor = 60s, .waiting = 1s}).check("wait").failure == "hang");
    }
}

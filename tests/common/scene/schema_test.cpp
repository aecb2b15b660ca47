// These tests check that scene.schema.json agrees with the reader: the same keys, and the same verdict on valid and
// invalid files.
#include "common/scene/json/json_reader.h"
#include "common/scene/scene.h"
#include "common/scene/json/scene_keys.h"

#include "tests/support/errors.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace duet;
using duet::test::error_of;
using duet::test::ScratchFolder;

namespace {

using Kind = JsonNode::Kind;
const std::filesystem::path kModels = std::filesystem::path(DUET_SOURCE_DIR) / "models";

const JsonNode* member(const JsonNode& node, const std::string& key) {
    const auto found = std::find(node.keys.begin(), node.keys.end(), key);
    return found == node.keys.end() ? nullptr : &node.items[static_cast<std::size_t>(found - node.keys.begin())];
}

bool same(const JsonNode& a, const JsonNode& b) {
    return a.kind == b.kind && a.number == b.number && a.text == b.text && a.boolean == b.boolean;
}

/// Implements the subset of JSON Schema (draft 2020-12) that scene.schema.json uses. Any other keyword fails the test.
class Validator {
public:
    explicit Validator(const JsonNode& schema) : root_(schema) {}
    bool accepts(const JsonNode& value) const { return check(root_, value); }

private:
    bool check(const JsonNode& schema, const JsonNode& value) const {
        for (std::size_t i = 0; i < schema.keys.size(); ++i)
            if (!keyword(schema.keys[i], schema.items[i], schema, value)) return false;
        return true;
    }

    bool keyword(const std::string& key, const JsonNode& rule, const JsonNode& schema, const JsonNode& value) const {
        const auto all = [&](const auto& test) { return std::all_of(value.items.begin(), value.items.end(), test); };
        const bool number = value.kind == Kind::kNumber, array = value.kind == Kind::kArray;
        if (key == "$schema" || key == "$defs" || key == "title" || key == "description" || key == "default")
            return true;
        if (key == "$ref") return check(definition(rule.text), value);
        if (key == "type") return has_type(rule.text, value);
        if (key == "const") return same(rule, value);
        if (key == "enum")
            return std::any_of(rule.items.begin(), rule.items.end(), [&](const JsonNode& n) { return same(n, value); });
        if (key == "anyOf")
            return std::any_of(rule.items.begin(), rule.items.end(),
                               [&](const JsonNode& s) { return check(s, value); });
        if (key == "minimum") return !number || value.number >= rule.number;
        if (key == "maximum") return !number || value.number <= rule.number;
        if (key == "exclusiveMinimum") return !number || value.number > rule.number;
        if (key == "minLength")
            return value.kind != Kind::kString || static_cast<double>(value.text.size()) >= rule.number;
        if (key == "minItems") return !array || static_cast<double>(value.items.size()) >= rule.number;
        if (key == "maxItems") return !array || static_cast<double>(value.items.size()) <= rule.number;
        if (key == "items") return !array || all([&](const JsonNode& item) { return check(rule, item); });
        if (key == "required")
            return std::all_of(rule.items.begin(), rule.items.end(),
                               [&](const JsonNode& name) { return member(value, name.text); });
        if (key == "properties") return properties(rule, value);
        if (key == "additionalProperties") return additional(rule, schema, value);
        FAIL("the schema uses the keyword " << key);
        return false;
    }

    const JsonNode& definition(const std::string& reference) const {
        REQUIRE(reference.starts_with("#/$defs/"));
        const JsonNode* found = member(*member(root_, "$defs"), reference.substr(8));
        REQUIRE_MESSAGE(found, reference);
        return *found;
    }
    static bool has_type(const std::string& type, const JsonNode& value) {
        if (type == "integer") return value.kind == Kind::kNumber && value.number == std::floor(value.number);
        const std::pair<const char*, Kind> names[] = {{"number", Kind::kNumber},
                                                      {"string", Kind::kString},
                                                      {"boolean", Kind::kBoolean},
                                                      {"array", Kind::kArray},
                                                      {"object", Kind::kObject}};
        return std::any_of(std::begin(names), std::end(names),
                           [&](const auto& n) { return type == n.first && value.kind == n.second; });
    }
    bool properties(const JsonNode& rules, const JsonNode& value) const {
        for (std::size_t i = 0; i < value.keys.size(); ++i)
            if (const JsonNode* rule = member(rules, value.keys[i]); rule && !check(*rule, value.items[i]))
                return false;
        return true;
    }
    bool additional(const JsonNode& rule, const JsonNode& schema, const JsonNode& value) const {
        const JsonNode* known = member(schema, "properties");
        for (std::size_t i = 0; i < value.keys.size(); ++i) {
            if (known && member(*known, value.keys[i])) continue;
            if (rule.kind == Kind::kBoolean ? !rule.boolean : !check(rule, value.items[i])) return false;
        }
        return true;
    }

    const JsonNode& root_;
};

JsonNode read(const std::filesystem::path& path) { return parse_json(path, read_file(path)); }
JsonNode schema() { return read(kModels / "scene.schema.json"); }

std::vector<std::string> sorted(std::vector<std::string> list) {
    std::sort(list.begin(), list.end());
    return list;
}

/// Holds the required and the allowed keys of a definition with fixed keys.
struct Definition {
    std::string name;
    std::vector<std::string> required, allowed;
};
std::vector<Definition> definitions(const JsonNode& root) {
    std::vector<Definition> list;
    const JsonNode& defs = *member(root, "$defs");
    for (std::size_t i = 0; i < defs.keys.size(); ++i) {
        const JsonNode* properties = member(defs.items[i], "properties");
        if (!properties) continue;
        Definition definition{defs.keys[i], {}, properties->keys};
        if (const JsonNode* required = member(defs.items[i], "required"))
            for (const JsonNode& name : required->items) definition.required.push_back(name.text);
        const JsonNode* closed = member(defs.items[i], "additionalProperties");
        CHECK_MESSAGE((closed && closed->kind == Kind::kBoolean && !closed->boolean),
                      definition.name << " allows other keys");
        list.push_back(definition);
    }
    return list;
}

/// Returns a small scene with one section replaced.
std::string scene(const std::string& camera, const std::string& materials, const std::string& objects,
                  const std::string& more = "") {
    return R"({"camera": )" + camera + R"(, "materials": )" + materials + R"(, "objects": )" + objects + more + "}";
}
const std::string kCamera = R"({"eye": [0, 0, 5], "look_at": [0, 0, 0]})", kMaterials = R"({"m": {"type": "diffuse"}})",
                  kObjects = "[]";

std::string material(const std::string& text) { return scene(kCamera, "{\"m\": " + text + "}", kObjects); }
std::string object(const std::string& text) { return scene(kCamera, kMaterials, "[" + text + "]"); }
std::string camera(const std::string& text) {
    return scene(R"({"eye": [0, 0, 5], "look_at": [0, 0, 0])" + text + "}", kMaterials, kObjects);
}
std::string more(const std::string& text) { return scene(kCamera, kMaterials, kObjects, ", " + text); }
std::string sphere(const std::string& text) {
    return object(R"({"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m")" + text + "}");
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("The schema has the reader's keys, and no others") {
        const JsonNode root = schema();
        const std::vector<Definition> defined = definitions(root);
        for (const JsonKeys& keys : scene_keys()) {
            CAPTURE(keys.kind);
            const auto found =
                std::find_if(defined.begin(), defined.end(), [&](const Definition& d) { return d.name == keys.kind; });
            REQUIRE(found != defined.end());
            std::vector<std::string> required(keys.required.begin(), keys.required.end()), allowed = required;
            allowed.insert(allowed.end(), keys.optional.begin(), keys.optional.end());
            CHECK(sorted(required) == sorted(found->required));
            CHECK(sorted(allowed) == sorted(found->allowed));
        }
        CHECK(defined.size() == scene_keys().size());
    }

    TEST_CASE("Every scene in models/ is accepted by the schema and loads") {
        const JsonNode root = schema();
        int scenes = 0;
        for (const auto& entry : std::filesystem::directory_iterator(kModels)) {
            if (entry.path().extension() != ".json" || entry.path().stem().extension() == ".schema") continue;
            CAPTURE(entry.path().filename());
            ++scenes;
            CHECK(Validator(root).accepts(read(entry.path())));
            const std::string error = error_of([&] { load_scene(entry.path()); });
            // The target `models` generates files that are too big to commit. They may be missing if only the tests
            // were built.
            if (error.find("/generated/") != std::string::npos && error.find("no such file") != std::string::npos)
                MESSAGE(error);
            else
                CHECK(error == "no error");
        }
        CHECK(scenes >= 3);
    }

    TEST_CASE("Schema and reader agree on what is good and what is bad") {
        const std::string good[] = {
            more(R"("description": "text")"),
            more(R"("image": {"width": 16384})"),
            camera(R"(, "fov_degrees": 179, "near": 0, "shutter": [0, 0])"),
            camera(R"(, "projection": "orthographic", "height": 1e-9)"),
            material(R"({"type": "diffuse", "albedo": [0, 1, 0.5]})"),
            material(R"({"type": "metal", "reflectance": 1, "roughness": 1})"),
            material(R"({"type": "dielectric", "ior": 4, "tint": [1, 1, 1]})"),
            material(R"({"type": "emissive", "radiance": [1e12, 0, 0], "two_sided": true, "albedo": 0.5})"),
            scene(kCamera,
                  R"({"m": {"type": "metal", "roughness": {"texture": "t", "scale": 0.5}, "normal": {"texture": "t"},
                            "bump": {"texture": "t", "scale": -2}, "opacity": {"texture": "t"}, "cutoff": 0.5}})",
                  kObjects, R"(, "textures": {"t": {"type": "noise"}})"),
            scene(kCamera, R"({"m": {"type": "emissive", "radiance": 1, "radiance_texture": "t"}})", kObjects,
                  R"(, "textures": {"t": {"type": "noise"}})"),
            material(R"({"type": "dielectric", "opacity": 0.5})"),
            scene(kCamera, R"({"m": {"type": "diffuse", "albedo": {"texture": "t", "tint": 0.5}}})", kObjects,
                  R"(, "textures": {"t": {"type": "noise", "octaves": 16}})"),
            more(R"("textures": {"t": {"type": "checker", "even": 1, "odd": [0, 0, 0], "scale": 3, "solid": false}})"),
            sphere(""),
            sphere(
                R"(, "transform": [{"translate": [1, 2, 3]}, {"scale": 2}, {"scale": [1, -2, 1]},
                                   {"rotate_degrees": 20, "axis": [0, 0, 3]}, {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0,
                                    0,0,0,1]}])"),
            sphere(R"(, "name": "ball", "transform_end": [{"translate": [1, 2, 3]}])"),
            object(R"({"type": "quad", "corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "material": "m"})"),
            object(R"({"type": "box", "low": [0, 0, 0], "high": [1, 1, 1], "material": "m"})"),
            object(R"({"type": "group", "name": "g", "hidden": true, "objects": []}, {"type": "instance", "of": "g"})"),
            more(
                R"("lights": [{"type": "point", "position": [0, 0, 0], "intensity": 1},
                              {"type": "spot", "position": [0, 0, 0], "direction": [0, 0, 1], "intensity": 1,
                               "inner_degrees": 0,
                               "outer_degrees": 180},
                              {"type": "sun", "direction": [0, 0, 1], "irradiance": 0}])"),
            more(R"("environment": {"type": "constant", "radiance": 0})"),
            more(R"("environment": {"type": "sky", "down": 1, "up": [0, 0, 1e12]})"),
        };
        // The reader tests cover what a schema cannot express (unknown names, singular transforms, missing files).
        const std::string bad[] = {
            "[]",
            "7",
            "{}",
            scene("7", kMaterials, kObjects),
            scene(kCamera, "[]", kObjects),
            scene(kCamera, kMaterials, "{}"),
            more(R"("lihgts": [])"),
            more(R"("description": 7)"),
            more(R"("description": "")"),
            more(R"("image": {"width": 0})"),
            more(R"("image": {"width": 2.5})"),
            more(R"("image": {"width": 16385})"),
            more(R"("image": {"depth": 3})"),
            more(R"("lights": {})"),
            more(R"("environment": 1)"),
            camera(R"(, "fov_degrees": 0)"),
            camera(R"(, "fov_degrees": 180)"),
            camera(R"(, "fov_degrees": "wide")"),
            camera(R"(, "near": -1)"),
            camera(R"(, "height": 2)"),
            camera(R"(, "up": [0, 1])"),
            camera(R"(, "up": [0, 1, 1e19])"),
            camera(R"(, "shutter": [0, 2])"),
            camera(R"(, "shutter": [0])"),
            camera(R"(, "projection": "fish")"),
            camera(R"(, "projection": "orthographic", "aperture_radius": 1)"),
            camera(R"(, "projection": "orthographic", "height": 0)"),
            material("{}"),
            material("1"),
            material(R"({"type": "difuse"})"),
            material(R"({"type": "diffuse", "albedo": 1.5})"),
            material(R"({"type": "diffuse", "albedo": [1, 1]})"),
            material(R"({"type": "diffuse", "albedo": "red"})"),
            material(R"({"type": "diffuse", "albedo": {"tint": 1}})"),
            material(R"({"type": "diffuse", "albedo": {"texture": 1}})"),
            material(R"({"type": "diffuse", "ior": 1})"),
            material(R"({"type": "metal", "roughness": 2})"),
            material(R"({"type": "metal", "roughness": [0, 0, 0]})"),
            material(R"({"type": "metal", "roughness": {"scale": 1}})"),
            material(R"({"type": "diffuse", "normal": "t"})"),
            material(R"({"type": "diffuse", "opacity": 1.5})"),
            material(R"({"type": "diffuse", "cutoff": -1})"),
            material(R"({"type": "emissive", "radiance": 1, "opacity": 0.5})"),
            more(R"("textures": {"t": {"type": "image", "file": "x", "values": "linear"}})"),
            more(R"("textures": {"t": {"type": "image", "file": "x", "channel": "luma"}})"),
            material(R"({"type": "dielectric", "ior": 0.9})"),
            material(R"({"type": "emissive"})"),
            material(R"({"type": "emissive", "radiance": -1})"),
            material(R"({"type": "emissive", "radiance": 1e13})"),
            material(R"({"type": "emissive", "radiance": 1, "two_sided": 1})"),
            more(R"("textures": {"t": {"type": "noise", "octaves": 0}})"),
            more(R"("textures": {"t": {"type": "noise", "octaves": 1.5}})"),
            more(R"("textures": {"t": {"type": "noise", "low": 2}})"),
            more(R"("textures": {"t": {"type": "checker", "scale": 0}})"),
            more(R"("textures": {"t": {"type": "checker", "file": "x"}})"),
            more(R"("textures": {"t": {"type": "image"}})"),
            more(R"("textures": {"t": {"type": "image", "file": "x", "filter": "cubic"}})"),
            more(R"("textures": {"t": {"type": "image", "file": "x", "scale": [1, 2, 3]}})"),
            object("{}"),
            object("1"),
            object(R"({"type": "cube"})"),
            object(R"({"type": "sphere", "center": [0, 0, 0], "radius": 0, "material": "m"})"),
            object(R"({"type": "sphere", "center": [0, 0, 0], "radius": 1})"),
            object(R"({"type": "box", "low": 0, "high": [1, 1, 1], "material": "m"})"),
            object(R"({"type": "mesh"})"),
            object(R"({"type": "mesh", "file": "x.obj", "normals": "soft"})"),
            object(R"({"type": "mesh", "file": ""})"),
            object(R"({"type": "group"})"),
            object(R"({"type": "group", "objects": {}})"),
            object(R"({"type": "group", "objects": [], "hidden": "yes"})"),
            object(R"({"type": "group", "objects": [{"type": "cube"}]})"),
            object(R"({"type": "instance"})"),
            sphere(R"(, "transform": {})"),
            sphere(R"(, "transform": [{}])"),
            sphere(R"(, "transform": [7])"),
            sphere(R"(, "transform": [{"scale": "big"}])"),
            sphere(R"(, "transform": [{"scale": [1, 2]}])"),
            sphere(R"(, "transform": [{"translate": 1}])"),
            sphere(R"(, "transform": [{"rotate_degrees": 1}])"),
            sphere(R"(, "transform": [{"axis": [1, 0, 0]}])"),
            sphere(R"(, "transform": [{"translate": [0, 0, 0], "scale": 1}])"),
            sphere(R"(, "transform": [{"matrix": [1, 0]}])"),
            sphere(R"(, "name": 3)"),
            sphere(R"(, "name": "")"),
            more(R"("lights": [{"type": "point", "position": [0, 0, 0]}])"),
            more(R"("lights": [{"type": "area_light"}])"),
            more(R"("lights": [{"type": "sun", "direction": 1, "irradiance": 1}])"),
            more(
                R"("lights": [{"type": "spot", "position": [0, 0, 0], "direction": [0, 0, 1], "intensity": 1,
                 "outer_degrees": 0}])"),
            more(R"("environment": {"type": "constant"})"),
            more(R"("environment": {"type": "sky", "left": 1})"),
            more(R"("environment": {"type": "image"})"),
            more(R"("environment": {"type": "image", "file": "x", "scale": -1})"),
        };
        const JsonNode root = schema();
        const ScratchFolder folder;
        const auto verdicts = [&](const std::string& text) {
            const std::filesystem::path path = folder.write("scene.json", text);
            return std::pair(Validator(root).accepts(read(path)), error_of([&] { load_scene(path); }));
        };
        for (const std::string& text : good) {
            const auto [schema_says, reader_says] = verdicts(text);
            CAPTURE(text);
            CHECK(schema_says);
            CHECK(reader_says == "no error");
        }
        for (const std::string& text : bad) {
            const auto [schema_says, reader_says] = verdicts(text);
            CAPTURE(text);
            CHECK_FALSE(schema_says);
            CHECK(reader_says != "no error");
        }
    }

    TEST_CASE("The examples of models/README.md can be loaded, beside a mesh.obj") {
        const std::string readme = read_file(kModels / "README.md");
        int examples = 0;
        for (std::size_t at = readme.find("```json\n"); at != std::string::npos;
             at = readme.find("```json\n", at + 1)) {
            const std::string text = readme.substr(at + 8, readme.find("```", at + 8) - at - 8);
            const ScratchFolder folder;
            folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
            CAPTURE(text);
            CHECK(error_of([&] { load_scene(folder.write("scene.json", text)); }) == "no error");
            ++examples;
        }
        CHECK(examples >= 2);
    }

} // TEST_SUITE

#include "compare/view/edits.h"

#include "common/scene/json/read_transform.h"
#include "common/system/error.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>

namespace duet::compare {

using nlohmann::ordered_json;

namespace {

ordered_json parsed(const std::string& text, const JsonPath& path) {
    return ordered_json::parse(value_text(text, path));
}

JsonPath operator/(JsonPath path, const std::string& key) {
    path.push_back(key);
    return path;
}

ordered_json vector(Vec3d v) { return {typed_number(v.x), typed_number(v.y), typed_number(v.z)}; }

Vec3d vector(const ordered_json& v) { return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()}; }

Mat4d matrix(const ordered_json& entries) {
    Mat4d m;
    for (std::size_t i = 0; i < 16; ++i) m[i / 4][i % 4] = entries.at(i).get<double>();
    return m;
}

ordered_json matrix(const Mat4d& m) {
    ordered_json entries;
    for (std::size_t i = 0; i < 16; ++i) entries.push_back(typed_number(m[i / 4][i % 4]));
    return entries;
}

/// Returns the keys of the points that determine the position of an element; none for one that only a transform can
/// move.
std::vector<std::string> places(const ordered_json& element) {
    if (element.contains("transform") || element.contains("transform_end")) return {};
    const std::string type = element.at("type");
    if (type == "sphere") return {"center"};
    if (type == "quad") return {"corner"};
    if (type == "point" || type == "spot") return {"position"};
    if (element.contains("low") && element.contains("high")) return {"low", "high"}; // a box, or a medium
    return {};
}

const ordered_json& value_at(const ordered_json& scene, const JsonPath& element) {
    return scene.at(element.front()).at(std::stoul(element.back()));
}
bool is_object(const JsonPath& element) { return element.front() == "objects"; }

/// Adds a step to the transform of an element, or changes its last step. `merged` returns the step that replaces the
/// last one, or null where both must remain.
template <typename Merge>
std::string with_step(std::string text, const JsonPath& element, const ordered_json& step, const Merge& merged) {
    for (const char* key : {"transform", "transform_end"}) {
        const ordered_json object = parsed(text, element);
        if (!object.contains(key)) {
            if (key == std::string("transform")) text = with_value(text, element / key, ordered_json::array({step}));
            continue;
        }
        ordered_json steps = object.at(key);
        const ordered_json last = steps.empty() ? ordered_json() : merged(steps.back());
        if (last.is_null())
            steps.push_back(step);
        else
            steps.back() = last;
        text = with_value(text, element / key, steps);
    }
    return text;
}

std::string first_material(std::string& text) {
    const ordered_json scene = ordered_json::parse(text);
    if (scene.contains("materials") && !scene.at("materials").empty()) return scene.at("materials").begin().key();
    text = with_value(text, {"materials"}, {{"clay", {{"type", "diffuse"}, {"albedo", 0.5}}}});
    return "clay";
}

std::string appended(std::string text, const std::string& list, const ordered_json& element) {
    const ordered_json scene = ordered_json::parse(text);
    if (!scene.contains(list)) return with_value(text, {list}, ordered_json::array({element}));
    return with_value(text, {list, std::to_string(scene.at(list).size())}, element);
}

} // namespace

double typed_number(double x) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), "%.7g", x);
    return std::strtod(digits.data(), nullptr);
}

std::string moved(const std::string& text, const JsonPath& element, Vec3d by) {
    const ordered_json object = parsed(text, element);
    const std::vector<std::string> points = places(object);
    std::string result = text;
    for (const std::string& point : points)
        result = with_value(result, element / point, vector(vector(object.at(point)) + by));
    if (!points.empty() || !is_object(element)) return result;
    return with_step(text, element, {{"translate", vector(by)}}, [&](const ordered_json& last) {
        if (!last.contains("translate")) return ordered_json();
        return ordered_json{{"translate", vector(vector(last.at("translate")) + by)}};
    });
}

std::string transformed(const std::string& text, const JsonPath& element, const Mat4d& map) {
    if (!is_object(element)) {
        const ordered_json own = parsed(text, element);
        std::string result = text;
        for (const std::string& point : places(own)) {
            const Vec3d from = vector(own.at(point)), to = transform_point(map, from);
            const bool stays = length(to - from) <= 1e-6 * length(from); // up to rounding
            if (!stays) result = with_value(result, element / point, vector(to));
        }
        if (!own.contains("direction")) return result;
        const Vec3d before = vector(own.at("direction")), after = transform_vector(map, before);
        if (!(length(after) > 0)) throw Error("a light without a direction cannot be turned");
        return with_value(result, element / "direction", vector(after * (length(before) / length(after))));
    }
    return with_step(text, element, {{"matrix", matrix(map)}}, [&](const ordered_json& last) {
        if (!last.contains("matrix")) return ordered_json();
        return ordered_json{{"matrix", matrix(map * matrix(last.at("matrix")))}};
    });
}

Handles handles(const ordered_json& scene, const JsonPath& element) {
    if (is_object(element)) return {true, true, true};
    const ordered_json& own = value_at(scene, element);
    return {.move = !places(own).empty(), .turn = own.contains("direction"), .scale = places(own).size() == 2};
}

Box3 place(const ordered_json& scene, const JsonPath& element) {
    const ordered_json& own = value_at(scene, element);
    Box3 box;
    for (const std::string& point : places(own)) box.extend(Vec3(vector(own.at(point))));
    return box;
}

std::array<Vec3d, 3> local_axes(const ordered_json& scene, const JsonPath& element) {
    const std::filesystem::path no_file;
    const JsonNode own = parse_json(no_file, value_at(scene, element).dump());
    const Mat4d map = is_object(element) ? read_motion(JsonValue(own, no_file)).start : Mat4d();
    const Vec3d x = normalize(transform_vector(map, Vec3d(1, 0, 0))), y = transform_vector(map, Vec3d(0, 1, 0));
    const Vec3d z = normalize(cross(x, y));
    return {x, cross(z, x), z};
}

namespace {

bool is_group(const ordered_json& element) { return element.value("type", "") == "group"; }

/// Calls visit for the elements of a list and of its groups.
template <typename Elements, typename Visit> void for_each_element(Elements& elements, const Visit& visit) {
    for (auto& element : elements) {
        visit(element);
        if (is_group(element) && element.contains("objects")) for_each_element(element.at("objects"), visit);
    }
}

} // namespace

// Names of groups are unique, so those of the copy are new, and its instances refer to them.
std::string duplicated(const std::string& text, const JsonPath& element) {
    const ordered_json scene = ordered_json::parse(text);
    ordered_json copy = ordered_json::array({value_at(scene, element)});
    std::set<std::string> used;
    if (scene.contains("objects"))
        for_each_element(scene.at("objects"), [&](const ordered_json& each) {
            if (is_group(each)) used.insert(each.value("name", ""));
        });
    std::map<std::string, std::string> renamed;
    for_each_element(copy, [&](ordered_json& each) {
        if (!is_group(each) || !each.contains("name")) return;
        const std::string name = each.at("name");
        std::string own = name;
        for (int i = 2; used.contains(own); ++i) own = name + " " + std::to_string(i);
        used.insert(own), renamed[name] = own;
        each["name"] = own;
    });
    for_each_element(copy, [&](ordered_json& each) {
        if (each.contains("of") && renamed.contains(each.at("of"))) each["of"] = renamed.at(each.at("of"));
    });
    return appended(text, element.front(), copy.front());
}

std::string with_own_material(const std::string& text, const JsonPath& element) {
    const ordered_json scene = ordered_json::parse(text), &materials = scene.at("materials");
    const std::string shared = value_at(scene, element).at("material");
    std::string own = shared;
    for (int i = 2; materials.contains(own); ++i) own = shared + " " + std::to_string(i);
    return with_value(with_value(text, {"materials", own}, materials.at(shared)), element / "material", own);
}

std::string with_new_element(const std::string& text, NewElement element, Vec3d at, double size) {
    const double half = size / 2;
    if (element == NewElement::kPointLight)
        return appended(text, "lights",
                        {{"type", "point"}, {"position", vector(at)}, {"intensity", typed_number(size * size)}});
    const Vec3d low = at - Vec3d(half, half, half), high = at + Vec3d(half, half, half);
    if (element == NewElement::kCloud)
        return appended(text, "media",
                        {{"type", "cloud"},
                         {"low", vector(low)},
                         {"high", vector(high)},
                         {"scattering", typed_number(20 / size)},
                         {"scale", typed_number(3 / size)},
                         {"resolution", 48}});
    std::string result = text;
    std::string material;
    if (element == NewElement::kAreaLight) {
        material = "new light";
        const ordered_json light{{"type", "emissive"}, {"radiance", 5}}, scene = ordered_json::parse(text);
        if (!scene.contains("materials"))
            result = with_value(text, {"materials"}, ordered_json{{material, light}});
        else if (!scene.at("materials").contains(material))
            result = with_value(text, {"materials", material}, light);
    } else {
        material = first_material(result);
    }
    ordered_json shape;
    if (element == NewElement::kSphere)
        shape = {{"type", "sphere"}, {"center", vector(at)}, {"radius", typed_number(half)}};
    else if (element == NewElement::kBox)
        shape = {{"type", "box"}, {"low", vector(low)}, {"high", vector(high)}};
    else { // the normal u × v of an area light points downward, that of a quad upward
        const Vec3d x(size, 0, 0), z(0, 0, size);
        const bool light = element == NewElement::kAreaLight;
        shape = {{"type", "quad"},
                 {"corner", vector(at - Vec3d(half, 0, half))},
                 {"u", vector(light ? x : z)},
                 {"v", vector(light ? z : x)}};
    }
    shape["material"] = material;
    return appended(result, "objects", shape);
}

std::string with_new_mesh(const std::string& text, const std::string& file) {
    return appended(text, "objects", {{"type", "mesh"}, {"file", file}});
}

} // namespace duet::compare

#include "compare/view/edits.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>

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

/// Returns the keys of the points that say where an element is; none for one that only a transform can move.
std::vector<std::string> places(const ordered_json& element) {
    if (element.contains("transform") || element.contains("transform_end")) return {};
    const std::string type = element.at("type");
    if (type == "sphere") return {"center"};
    if (type == "quad") return {"corner"};
    if (type == "box") return {"low", "high"};
    return {};
}

/// Adds a step to the transform of an element, or changes its last step. `merged` returns the step that replaces the
/// last one, or null where both must stay.
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
    if (!points.empty()) return result;
    return with_step(text, element, {{"translate", vector(by)}}, [&](const ordered_json& last) {
        if (!last.contains("translate")) return ordered_json();
        return ordered_json{{"translate", vector(vector(last.at("translate")) + by)}};
    });
}

std::string transformed(const std::string& text, const JsonPath& element, const Mat4d& map) {
    return with_step(text, element, {{"matrix", matrix(map)}}, [&](const ordered_json& last) {
        if (!last.contains("matrix")) return ordered_json();
        return ordered_json{{"matrix", matrix(map * matrix(last.at("matrix")))}};
    });
}

std::string duplicated(const std::string& text, const JsonPath& element) {
    ordered_json copy = parsed(text, element);
    if (copy.value("type", "") == "group") copy.erase("name"); // names of groups are unique
    return appended(text, element.front(), copy);
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
    else { // an area light's normal, u × v, points downward, a quad's upward
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

#include "compare/stress/scenes/schema_values.h"

#include "common/system/error.h"
#include "compare/stress/scenes/scene_files.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace duet::compare {

namespace {

constexpr int kMostObjects = 24, kDeepest = 12;
/// Numbers of a range narrower than this are drawn uniformly. Numbers of wider ranges are about 1.
constexpr double kNarrow = 1000;

/// These are the keywords that say nothing about a value.
const std::set<std::string> kAnnotations = {"$schema", "$defs", "title", "description", "default"};
/// These are the keywords and types that decide how a value is drawn, each with the other keywords that may accompany
/// it.
const std::map<std::string, std::set<std::string>> kKinds = {
    {"$ref", {}},
    {"const", {}},
    {"enum", {}},
    {"anyOf", {}},
    {"object", {"type", "properties", "required", "additionalProperties"}},
    {"array", {"type", "items", "minItems", "maxItems"}},
    {"string", {"type", "minLength"}},
    {"boolean", {"type"}},
    {"number", {"type", "minimum", "exclusiveMinimum", "maximum"}},
    {"integer", {"type", "minimum", "exclusiveMinimum", "maximum"}}};

/// Returns the kind of a schema, a key of kKinds. Throws Error if it has none, or a keyword that kKinds does not list
/// for its kind.
std::string kind_of(const Json& schema) {
    const auto fail = [&](const std::string& expected) {
        throw Error(message("the scene's schema: found ", schema.dump().substr(0, 80), ", expected ", expected));
    };
    for (const auto& [kind, beside] : kKinds) {
        if (!schema.contains(kind) && schema.value("type", "") != kind) continue;
        for (const auto& [keyword, rule] : schema.items())
            if (keyword != kind && !beside.contains(keyword) && !kAnnotations.contains(keyword))
                fail("no " + keyword + " beside " + kind);
        return kind;
    }
    fail("$ref, const, enum, anyOf or a type");
    return {};
}

/// These keys refer to a name in the list that is given beside each.
const std::map<std::string, std::string> kReferences = {{"texture", "textures"},
                                                        {"radiance_texture", "textures"},
                                                        {"material", "materials"},
                                                        {"of", "groups"}};
/// Vectors under these keys are points, which are drawn around the middle of the scene.
const std::set<std::string> kPoints = {"eye", "look_at", "corner", "center", "low", "high", "position"};
/// Numbers under these keys are not lengths.
const std::set<std::string> kUnitless = {"up", "axis", "direction", "scale", "matrix", "rotate_degrees"};
/// Numbers of these definitions are lengths, unless their key is unitless.
const std::set<std::string> kLengths = {"number", "positive", "notNegative"};

/// Sorts the corners of a box on each axis, and gives the box an extent.
void repair_box(Json& low, Json& high) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (low[i] > high[i]) std::swap(low[i], high[i]);
        if (low[i] == high[i]) low[i] = low[i].get<double>() - std::max(1.0, std::abs(low[i].get<double>()));
    }
}

/// Makes a transform's step invertible.
void repair_step(Json& step) {
    if (step.contains("matrix"))
        for (std::size_t i = 12; i < 16; ++i) step["matrix"][i] = i < 15 ? 0 : 1;
    if (!step.contains("scale")) return;
    for (Json& x : step["scale"]) // the components, or the number itself
        if (x == 0) x = 1;
}

/// Makes the diagonal of a matrix outweigh the rest of each row. This also holds for every mean of the matrix and the
/// identity, so that a motion from the identity to it is never singular.
void repair_motion_matrix(Json& matrix) {
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) {
            Json& x = matrix[4 * row + column];
            x = row == column ? 1 + std::abs(std::fmod(x.get<double>(), 1)) : std::fmod(x.get<double>(), 0.4);
        }
}

/// Makes the end of a motion its beginning followed by small steps, so that the interpolated transform is never
/// singular.
void repair_motion(Json& object) {
    Json steps = object.value("transform", Json::array());
    for (Json& step : object["transform_end"]) {
        if (step.contains("matrix")) repair_motion_matrix(step["matrix"]);
        if (step.contains("rotate_degrees"))
            step["rotate_degrees"] = std::fmod(step["rotate_degrees"].get<double>(), 60);
        if (step.contains("scale"))
            for (Json& x : step["scale"]) x = std::abs(x.get<double>());
        steps.push_back(std::move(step));
    }
    object["transform_end"] = std::move(steps);
}

/// Returns whether an object moves, or one of its members, also by way of an instance of a moving group.
bool moves(const Json& object, const std::set<std::string>& moving_groups) {
    if (object.contains("transform_end") || moving_groups.contains(object.value("of", ""))) return true;
    const Json members = object.value("objects", Json::array());
    return std::ranges::any_of(members, [&](const Json& member) { return moves(member, moving_groups); });
}

/// Removes the motion of an object that contains moving objects, because the product of both may be singular in
/// between.
void repair_nested_motion(Json& object, const std::set<std::string>& moving_groups) {
    if (!object.contains("transform_end")) return;
    Json rest = object;
    rest.erase("transform_end");
    if (moves(rest, moving_groups)) object.erase("transform_end");
}

void repair_subsurface(Json& object) {
    if (object.contains("measured")) {
        for (const char* key : {"albedo", "mean_free_path"}) object.erase(key);
    } else {
        object.erase("scale");
        if (!object.contains("mean_free_path")) object["mean_free_path"] = 0.1;
    }
}

/// Repairs what the schema allows but the format does not (models/README.md).
void repair(Json& object, const std::string& definition) {
    const std::string type = object.value("type", "");
    const bool has_corners = object.contains("low") && object.contains("high");
    if (has_corners && (type == "box" || type == "fog" || type == "cloud" || type == "smoke"))
        repair_box(object["low"], object["high"]);
    if (type == "cloud") // a scene's grids are limited in their total number of points
        object["resolution"] = 1 + object.value("resolution", 12) % 24;
    if (type == "smoke") object["resolution"] = kGridPoints;
    if (object.contains("transform_end")) repair_motion(object);
    if (object.contains("conductor")) object.erase("reflectance");
    if (type == "dielectric" && object.value("thin", false))
        for (const char* key : {"roughness", "absorption", "priority"}) object.erase(key);
    if (type == "subsurface") repair_subsurface(object);
    if (type == "principled" && object.contains("subsurface") != object.contains("mean_free_path"))
        for (const char* key : {"subsurface", "mean_free_path"}) object.erase(key);
    if (object.contains("outer_degrees"))
        object["inner_degrees"] = object["outer_degrees"].get<double>() * object.value("inner_degrees", 90.0) / 200;
    else
        object.erase("inner_degrees");
    if (object.contains("shutter") && object["shutter"][0] > object["shutter"][1])
        std::swap(object["shutter"][0], object["shutter"][1]);
    if (definition == "scale" || definition == "matrix") repair_step(object);
}

} // namespace

Json SchemaValues::scene() {
    Json result = *value(schema_, {});
    if (!points_.empty() && chance(0.8)) // aims the camera at an object or light
        result["camera"]["look_at"] = element(points_);
    return result;
}

std::optional<Json> SchemaValues::value(const Json& schema, Place place) {
    const std::string kind = kind_of(schema);
    if (kind == "$ref") {
        place.definition = schema["$ref"].get<std::string>().substr(std::string_view("#/$defs/").size());
        return value(schema_["$defs"].at(place.definition), place);
    }
    if (kind == "const") return schema["const"];
    if (kind == "enum") return element(schema["enum"]);
    if (kind == "anyOf") return any_of(schema["anyOf"], place);
    if (kind == "object") return object(schema, place);
    if (kind == "array") return array(schema, place);
    if (kind == "string") return text(place);
    if (kind == "boolean") return Json(random_.coin());
    return number(schema, place);
}

/// Draws one alternative after the other, in random order, until one is possible.
std::optional<Json> SchemaValues::any_of(const Json& alternatives, const Place& place) {
    const auto count = static_cast<std::uint32_t>(alternatives.size());
    const std::uint32_t first = random_.below(count);
    for (std::uint32_t i = 0; i < count; ++i)
        if (std::optional<Json> drawn = value(alternatives[(first + i) % count], place)) return drawn;
    return {};
}

std::optional<Json> SchemaValues::object(const Json& schema, const Place& place) {
    Json result = Json::object();
    const Json required = schema.value("required", Json::array());
    const auto is_required = [&](const std::string& key) {
        return std::find(required.begin(), required.end(), key) != required.end();
    };
    const Json properties = schema.value("properties", Json::object());
    const double present = place.depth == 0 ? 0.9 : 0.4; // depth 0: the scene itself
    for (const auto& [key, rule] : properties.items()) {
        if (!is_required(key) && !chance(present)) continue;
        std::optional<Json> drawn = value(rule, {"", key, place.definition, place.depth + 1});
        if (drawn)
            result[key] = std::move(*drawn);
        else if (is_required(key))
            return {};
    }
    if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object())
        for (std::uint32_t i = random_.below(5) + 1; i > 0; --i) {
            const std::string name = message(place.key, ' ', i);
            if (std::optional<Json> drawn = value(schema["additionalProperties"], {"", "", "", place.depth + 1})) {
                result[name] = std::move(*drawn);
                names_[place.key].push_back(name);
            }
        }
    repair(result, place.definition);
    repair_nested_motion(result, moving_groups_);
    if (result.value("type", "") == "group") {
        if (!result.contains("name")) result["name"] = message("group ", names_["groups"].size());
        names_["groups"].push_back(result["name"]);
        if (moves(result, moving_groups_)) moving_groups_.insert(result["name"]);
    }
    return result;
}

std::optional<Json> SchemaValues::array(const Json& schema, const Place& place) {
    constexpr std::uint32_t kUsualItems = 6; // more items take time, and find no other faults
    const auto least = schema.value("minItems", 0u),
               most = std::max(least, std::min(schema.value("maxItems", kUsualItems), kUsualItems));
    const bool objects = place.key == "objects";
    if (objects && place.depth > kDeepest) return {};
    std::uint32_t count = least + random_.below(most - least + 1);
    if (objects) count += place.depth == 1 ? 3 : 1;
    Json result = Json::array();
    const bool point = place.definition == "vector" && kPoints.contains(place.key);
    for (std::uint32_t i = 0; i < count; ++i) {
        if (objects && ++objects_ > kMostObjects) break;
        Place item = place;
        ++item.depth;
        std::optional<Json> drawn = value(schema["items"], item);
        if (!drawn) continue;
        if (point) *drawn = std::clamp(drawn->get<double>() + sizes_.middle[i], -1e18, 1e18);
        result.push_back(std::move(*drawn));
    }
    if (result.size() < least) return {};
    if (point && place.key != "eye" && place.key != "look_at") points_.push_back(result);
    return result;
}

std::optional<Json> SchemaValues::one_of(const std::vector<std::string>& names) {
    if (names.empty()) return {};
    return Json(element(names));
}

std::optional<Json> SchemaValues::text(const Place& place) {
    if (const auto names = kReferences.find(place.key); names != kReferences.end())
        return one_of(names_[names->second]);
    if (place.key == "file") {
        const auto names = files_.find(place.holder);
        if (names == files_.end()) throw Error(message("no files for ", place.holder, ".file: add some"), 1);
        return one_of(names->second);
    }
    return Json(message(random_.coin() ? "a \"name\" \\ of \t" : "é, 漢字, \x01 ", random_.below(1u << 20)));
}

Json SchemaValues::number(const Json& schema, const Place& place) {
    const double above = schema.value("exclusiveMinimum", -1e18);
    const double low = schema.value("minimum", above >= 0 ? 1e-18 : above), high = schema.value("maximum", 1e18);
    const bool any = chance(sizes_.extreme);
    const double drawn = std::clamp(any ? any_number(low, high) : ordinary_number(low, high, place), low, high);
    if (schema["type"] == "integer") return std::llround(drawn);
    return drawn;
}

/// Returns a number from anywhere in the range: its ends, 0, 1, or one of any magnitude.
double SchemaValues::any_number(double low, double high) {
    const double sign = low < 0 && random_.coin() ? -1 : 1;
    switch (random_.below(6)) {
    case 0: return low;
    case 1: return high;
    case 2: return 0;
    case 3: return sign;
    default: return sign * static_cast<double>(random_.log_uniform(1e-18f, 1e18f));
    }
}

double SchemaValues::ordinary_number(double low, double high, const Place& place) {
    if (high - low <= kNarrow) return chance(0.1) ? random_.coin() ? low : high
                                                  : low + (high - low) * static_cast<double>(random_.uniform());
    const bool length = kLengths.contains(place.definition) && !kUnitless.contains(place.key);
    const double unit = length ? sizes_.unit : 1;
    if (low < 0) return chance(0.1) ? 0 : 3 * unit * static_cast<double>(random_.uniform(-1, 1));
    if (low == 0 && chance(0.2)) return 0;
    return unit * static_cast<double>(random_.log_uniform(0.1f, 3));
}

} // namespace duet::compare

// This file draws random values that a JSON schema allows. Rules for certain keys add what the schema cannot say: names
// refer to values that were drawn before, coordinates of one scene have one size, and pairs such as a box's corners are
// in order.
#pragma once

#include "compare/stress/trials.h"

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace duet::compare {

/// This JSON type keeps the order of members. The schema lists named things before those that refer to them.
using Json = nlohmann::ordered_json;

/// Holds the sizes of the numbers of one scene.
struct SceneSizes {
    double unit = 1;                ///< coordinates are within a few units of the middle
    std::array<double, 3> middle{}; ///< of the scene, in meters
    double extreme = 0;             ///< probability of a number from anywhere in its range
};

/// Draws the value of one scene. All values that the schema allows can come up: every key, every kind, all numbers.
class SchemaValues {
public:
    /// The schema may use those features of JSON Schema that models/scene.schema.json uses. Throws Error, naming the
    /// keyword, for others. `files` holds the names of the files for each definition with a key `file`, such as "mesh".
    SchemaValues(const Json& schema, const std::map<std::string, std::vector<std::string>>& files,
                 const SceneSizes& sizes, TrialRandom& random)
        : schema_(schema), files_(files), sizes_(sizes), random_(random) {}

    /// Draws a scene.
    Json scene();

private:
    /// Describes a value before it is drawn: its definition, the key that holds it, and the definition of the object
    /// that has this key.
    struct Place {
        std::string definition, key, holder;
        int depth = 0; ///< number of arrays and objects around it
    };
    /// Each function returns nothing where no value is possible, such as a texture's name in a scene without textures.
    std::optional<Json> value(const Json& schema, Place place);
    std::optional<Json> any_of(const Json& alternatives, const Place& place);
    std::optional<Json> object(const Json& schema, const Place& place);
    std::optional<Json> array(const Json& schema, const Place& place);
    std::optional<Json> text(const Place& place);
    Json number(const Json& schema, const Place& place);
    double any_number(double low, double high);
    double ordinary_number(double low, double high, const Place& place);
    bool chance(double probability) { return static_cast<double>(random_.uniform()) < probability; }
    std::optional<Json> one_of(const std::vector<std::string>& names);
    template <typename List> const auto& element(const List& list) {
        return list[random_.below(static_cast<std::uint32_t>(list.size()))];
    }

    const Json& schema_;
    const std::map<std::string, std::vector<std::string>>& files_;
    SceneSizes sizes_;
    TrialRandom& random_;
    std::map<std::string, std::vector<std::string>> names_; ///< drawn so far: "textures", "materials", "groups"
    std::set<std::string> moving_groups_; ///< names of the groups drawn so far that move, or some of whose members move
    std::vector<Json> points_;                              ///< positions of objects and lights
    int objects_ = 0;
};

} // namespace duet::compare

// This file edits the text of a scene file in place, so that everything else in it stays as it was typed.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace duet::compare {

/// A JsonPath holds the keys that lead to a value, from the outermost object on. An element of an array has its index
/// as key: {"objects", "3", "material"}.
using JsonPath = std::vector<std::string>;

// All texts must be valid JSON. The functions throw Error if the text has no value at the path, or no object or array
// to add a value to.

/// Returns the text of the value at a path.
std::string_view value_text(std::string_view text, const JsonPath& path);
/// Returns the text with another value at a path. A missing value is appended to its object or array.
std::string with_value(std::string_view text, const JsonPath& path, const nlohmann::ordered_json& value);
/// Returns the text without the value at a path.
std::string without_value(std::string_view text, const JsonPath& path);

/// Formats a value as people type it, on one line: {"center": [0, 1, 2], "radius": 0.5}.
std::string typed_json(const nlohmann::ordered_json& value);

} // namespace duet::compare

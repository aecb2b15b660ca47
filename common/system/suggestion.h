// This file suggests what a user may have meant by an unknown name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace duet {

/// Returns "; did you mean "X"?" for the known name nearest to `name`, or an empty string where none is near.
std::string suggestion(std::string_view name, const std::vector<std::string_view>& known);
/// Returns the names in double quotes, with commas between them.
std::string listed(const std::vector<std::string_view>& names);
/// Returns suggestion(), or "; expected one of …" with all known names where none is near.
std::string suggestion_or_list(std::string_view name, const std::vector<std::string_view>& known);

} // namespace duet

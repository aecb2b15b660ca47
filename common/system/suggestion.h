// This file looks up names, and suggests what a user may have meant by an unknown one.
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
/// Returns the index of a name among the known ones. Throws Error for an unknown name, with suggestion_or_list().
/// `what` is the kind of the name, such as "integrator", or the option that takes it.
std::size_t name_index(const char* what, std::string_view name, const std::vector<std::string_view>& known);

} // namespace duet

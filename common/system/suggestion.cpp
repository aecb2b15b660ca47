#include "common/system/suggestion.h"

#include "common/system/error.h"
#include "common/system/escape.h"

#include <algorithm>

namespace duet {

namespace {

/// Returns the least number of insertions, deletions, replacements and swaps of neighbors that turn one short word
/// into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

} // namespace

std::string suggestion(std::string_view name, const std::vector<std::string_view>& known) {
    if (name.size() > 40) return "";
    std::string_view nearest;
    // Up to a third of the letters plus one may differ, but not all.
    std::size_t least = std::min(name.size() / 3 + 2, name.size());
    for (const std::string_view candidate : known) {
        if (candidate.size() > 40) continue;
        const std::size_t distance = edit_distance(name, candidate);
        if (distance < least) {
            least = distance;
            nearest = candidate;
        }
    }
    return nearest.empty() ? "" : "; did you mean " + quoted_text(nearest) + "?";
}

std::string listed(const std::vector<std::string_view>& names) {
    std::string list;
    for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + quoted_text(name);
    return list;
}

std::string suggestion_or_list(std::string_view name, const std::vector<std::string_view>& known) {
    const std::string nearest = suggestion(name, known);
    return nearest.empty() ? "; expected one of " + listed(known) : nearest;
}

std::size_t name_index(const char* what, std::string_view name, const std::vector<std::string_view>& known) {
    const auto found = std::ranges::find(known, name);
    if (found == known.end())
        throw Error(message(what, ": found ", quoted_text(name), suggestion_or_list(name, known)));
    return static_cast<std::size_t>(found - known.begin());
}

} // namespace duet

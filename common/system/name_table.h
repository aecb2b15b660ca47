// A NameTable holds the names of values, as users write them in options and files.
#pragma once

#include "common/system/error.h"
#include "common/system/suggestion.h"

#include <algorithm>
#include <array>
#include <utility>

namespace duet {

/// Holds N names of values, each once.
template <typename Value, std::size_t N> struct NameTable {
    const char* what; ///< name of the kind of value, such as "integrator", or of the option for it
    std::array<std::pair<std::string_view, Value>, N> entries;

    /// Returns the value of a name. Throws Error for an unknown name, with the nearest known one or a list.
    Value value(std::string_view name) const { return entries[name_index(what, name, names())].second; }
    /// Returns all names, in the order of the table.
    std::vector<std::string_view> names() const {
        std::vector<std::string_view> list;
        for (const auto& entry : entries) list.push_back(entry.first);
        return list;
    }
    /// Returns the name of a value, which must be in the table.
    std::string_view name(Value value) const {
        const auto found = std::ranges::find(entries, value, [](const auto& entry) { return entry.second; });
        DUET_CHECK(found != entries.end());
        return found->first;
    }
};

} // namespace duet

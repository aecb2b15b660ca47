// This file formats numbers, lists and tables as text.
#pragma once

#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

namespace duet::compare {

/// Returns what printf would print, up to 255 characters.
template <typename... Values> std::string formatted(const char* format, Values... values) {
    char text[256];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

/// Returns the number with this number of digits after the point.
inline std::string fixed(double value, int digits) { return formatted("%.*f", digits, value); }
/// Returns the number with at most this number of significant digits.
inline std::string significant(double value, int digits) { return formatted("%.*g", digits, value); }
/// Returns a time in milliseconds, without the unit: with two digits after the point below 10 ms, else with one.
inline std::string milliseconds(double seconds) { return fixed(1000 * seconds, seconds < 0.01 ? 2 : 1); }

/// Returns the strings with the separator between them.
template <typename List> std::string joined(const List& list, const char* separator = ", ") {
    std::string text;
    const char* before = "";
    for (const auto& one : list) {
        text += before;
        text += one;
        before = separator;
    }
    return text;
}

/// Prints a line of a table. A cell is filled with blanks to its width, and stands at its left where the width is
/// negative. A short line has no cells in the last columns.
void print_cells(std::ostream& out, const std::vector<int>& widths, const std::vector<std::string>& cells);

} // namespace duet::compare

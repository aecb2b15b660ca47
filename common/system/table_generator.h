// Some tables are computed when the project is built, by programs that write them as C++ source. This file holds the
// functions that these programs share.
#pragma once

#include <cstdio>
#include <fstream>
#include <iostream>
#include <ostream>
#include <span>

namespace duet {

/// Writes the numbers as one braced list of float literals, such as "{1.000000000e+00f, },". Nine decimal places
/// identify every float exactly.
inline void write_floats(std::ostream& out, std::span<const float> numbers) {
    out << "{";
    for (const float number : numbers) {
        char text[32];
        std::snprintf(text, sizeof text, "%.9ef, ", static_cast<double>(number));
        out << text;
    }
    out << "},\n";
}

/// Implements main() of a table generator, whose only argument is the path of the output file; write(out) writes the
/// contents. Returns the exit code: 0 on success, 1 if writing fails, 2 for wrong arguments.
template <typename Write> int generate_table(int count, char** arguments, const char* program, const Write& write) {
    if (count != 2) {
        std::cerr << "usage: " << program << " OUT.cpp\n";
        return 2;
    }
    std::ofstream out(arguments[1]);
    write(out);
    out.close();
    return out ? 0 : 1;
}

} // namespace duet

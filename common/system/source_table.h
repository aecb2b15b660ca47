// Tables that are computed when the project is built, written as C++ source: what the programs that do so share.
#pragma once

#include <cstdio>
#include <fstream>
#include <iostream>
#include <ostream>
#include <span>

namespace duet {

/// "{1.000000000e+00f, …},": nine digits bring back every float.
inline void write_numbers(std::ostream& out, std::span<const float> numbers) {
    out << "{";
    for (const float number : numbers) {
        char text[32];
        std::snprintf(text, sizeof text, "%.9ef, ", static_cast<double>(number));
        out << text;
    }
    out << "},\n";
}

/// The main function of such a program, whose only argument is the file to write; write(out) writes it. The exit code.
template <typename Write> int write_source(int count, char** arguments, const char* program, const Write& write) {
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

// Some tables are computed when the project is built, by programs that write them as C++ source. This file holds the
// functions that these programs share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <ostream>

namespace duet {

/// Writes the numbers as one braced list of float literals, such as "{1.000000000e+00f, },". Nine decimal places
/// identify every float exactly.
template <std::size_t count> void write_table(std::ostream& out, const std::array<float, count>& numbers) {
    out << "{";
    for (const float number : numbers) {
        char text[32];
        std::snprintf(text, sizeof text, "%.9ef, ", static_cast<double>(number));
        out << text;
    }
    out << "},\n";
}
/// Writes an array of tables, or of arrays of tables.
template <typename Table, std::size_t count>
void write_table(std::ostream& out, const std::array<Table, count>& tables) {
    out << "{{\n";
    for (const Table& table : tables) write_table(out, table);
    out << "}},\n";
}

/// Describes what a table generator writes: the definition of a variable, such as "Table kTable" in the namespace
/// "duet". The header defines the variable's type.
struct TableSource {
    const char *program, *header, *name_space, *variable;
};

/// Implements main() of a table generator, whose only argument is the path of the output file; write(out) writes the
/// variable's members. Returns the exit code: 0 on success, 1 if writing fails, 2 for wrong arguments.
template <typename Write>
int generate_table(int count, char** arguments, const TableSource& source, const Write& write) {
    if (count != 2) {
        std::cerr << "usage: " << source.program << " OUT.cpp\n";
        return 2;
    }
    std::ofstream out(arguments[1]);
    out << "#include \"" << source.header << "\"\n\nnamespace " << source.name_space << " {\n\nextern const "
        << source.variable << ";\nconst " << source.variable << "{\n";
    write(out);
    out << "};\n\n} // namespace " << source.name_space << '\n';
    out.close();
    return out ? 0 : 1;
}

} // namespace duet

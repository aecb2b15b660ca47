// Writes the table of raster/ggx_table.h as a source file, when the project is built.
#include "raster/ggx_fit.h"

#include <cstdio>
#include <fstream>
#include <iostream>

using namespace duet::raster;

namespace {

template <std::size_t N, int Side>
void write(std::ostream& out, const char* name, const GgxTable<N, Side>& table) {
    out << "extern const GgxTable<" << N << ", " << Side << "> " << name << ";\nconst GgxTable<" << N << ", " << Side << "> " << name
        << "{{{\n";
    for (const auto& entry : table.entries) {
        out << "    {";
        for (const float number : entry) {
            char text[32];
            std::snprintf(text, sizeof text, "%.9ef, ", static_cast<double>(number)); // nine digits bring back every float
            out << text;
        }
        out << "},\n";
    }
    out << "}}};\n";
}

} // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::cerr << "usage: make_ggx_table OUT.cpp\n";
        return 2;
    }
    std::ofstream out(arguments[1]);
    out << "#include \"raster/ggx_fit.h\"\n\nnamespace duet::raster {\n\n";
    write(out, "kLobeTable", compute_lobe_table());
    out << "\n} // namespace duet::raster\n";
    out.close();
    return out ? 0 : 1;
}

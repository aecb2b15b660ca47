// This program writes the table of raster/lighting/ggx_fit.h as a source file when the project is built.
#include "raster/lighting/ggx_fit.h"

#include "common/system/table_generator.h"

using namespace duet;
using namespace duet::raster;

namespace {

template <std::size_t N, int Side>
void write(std::ostream& out, const char* name, const GgxTable<N, Side>& table) {
    out << "extern const GgxTable<" << N << ", " << Side << "> " << name << ";\nconst GgxTable<" << N << ", " << Side
        << "> " << name << "{{{\n";
    for (const auto& entry : table.entries) write_floats(out, entry);
    out << "}}};\n";
}

} // namespace

int main(int count, char** arguments) {
    return generate_table(count, arguments, "make_ggx_table", [](std::ostream& out) {
        out << "#include \"raster/lighting/ggx_fit.h\"\n\nnamespace duet::raster {\n\n";
        write(out, "kLobeTable", compute_lobe_table());
        out << "\n} // namespace duet::raster\n";
    });
}

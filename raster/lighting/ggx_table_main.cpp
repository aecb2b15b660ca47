// This program writes the table of raster/lighting/ggx_fit.h as a source file when the project is built.
#include "raster/lighting/ggx_fit.h"

#include "common/system/table_generator.h"

using namespace duet;
using namespace duet::raster;

int main(int count, char** arguments) {
    const TableSource source{"make_ggx_table", "raster/lighting/ggx_fit.h", "duet::raster",
                             "GgxTable<5, kLobeSide> kLobeTable"};
    return generate_table(count, arguments, source,
                          [](std::ostream& out) { write_table(out, compute_lobe_table().entries); });
}

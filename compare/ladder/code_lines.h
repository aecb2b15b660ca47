// What each rung of the ladder costs in code: counted when the program is built, from the files that code.txt names.
#pragma once

#include <span>
#include <string_view>

namespace duet::compare {

struct CodeFile {
    int rung;              ///< 1 to kRungCount; 0: the frame around all
    std::string_view side; ///< "raster", "raytrace", or "both": shared code
    std::string_view path; ///< from the top of the sources
    int lines;             ///< neither blank nor only comment
};
/// In the order of the table.
std::span<const CodeFile> code_files();

} // namespace duet::compare

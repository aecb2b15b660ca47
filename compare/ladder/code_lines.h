// Lines of code of each rung of the ladder. They are counted at build time, in the files that the
// units of code.txt include.
#pragma once

#include <span>
#include <string_view>

namespace duet::compare {

/// Names a source file, and the rung whose quantity it computes.
struct CodeFile {
    int rung;              ///< 1 to kRungCount; 0: code that belongs to no rung
    std::string_view side; ///< "raster", "raytrace", or "both" for shared code
    std::string_view path; ///< relative to the root of the sources
    int lines;             ///< neither blank nor comment only
};
/// Returns the files sorted by path. Each source of raster/ and raytrace/ is there once, but for main files and
/// lessons.
std::span<const CodeFile> code_files();

} // namespace duet::compare

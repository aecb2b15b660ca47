// This file lists the lines of code of each rung of the ladder. They are counted at build time, in the files that the
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
    int lines;             ///< lines that are neither blank nor only a comment
};
/// Returns the files sorted by path: each source of raster/ and raytrace/ once, except main files and lessons.
std::span<const CodeFile> code_files();

} // namespace duet::compare

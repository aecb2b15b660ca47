// `compare kernels`: measures the speed of Duet's ray kernels and of Embree's on the same rays.
#pragma once

#include "compare/kernels/measure_kernels.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds the options of `compare kernels`.
struct KernelsOptions {
    std::vector<std::filesystem::path> meshes;
    std::vector<std::string> scenes{"alone", "room"}; ///< for bare meshes; a scene file is always "alone"
    std::vector<std::string> peers;                   ///< Embree's settings (name_of), or "none"; empty: all
    KernelSettings settings; ///< `works` empty: all; `threads` 0: all hardware threads; `peers` follow from the names
    std::string stats;       ///< file for the rows as JSON; "-" for standard output; empty: none
    bool quiet = false;
};

/// Prints one table per scene. Returns 1 if any of Duet's results is wrong or a ray leaked, 130 after an
/// interrupt signal. Throws Error for files and names that cannot be used.
int kernels(const KernelsOptions& options);

} // namespace duet::compare

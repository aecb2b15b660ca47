// `compare kernels`: measures the speed of Duet's ray kernels and of Embree's on the same rays.
#pragma once

#include "common/program/command_line.h"
#include "compare/kernels/kernel_report.h"
#include "compare/kernels/kernel_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

struct KernelsOptions {
    std::vector<std::filesystem::path> meshes;
    std::vector<std::string> scenes{"alone", "room"}; ///< for bare meshes; a scene file is always "alone"
    std::vector<std::string> works;                   ///< some of kWorks; empty: all
    std::vector<std::string> peers;                   ///< Embree's settings (name_of), or "none"; empty: all
    ImageSize size{1920, 1080};                       ///< one camera ray per pixel
    int threads = 0;                                  ///< for the multithreaded rows; 0: all hardware threads
    int repeats = 7;
    double seconds = 0.15;               ///< duration of one measurement in seconds
    std::int64_t watertight = 1'000'000; ///< number of rays aimed from inside closed scenes; 0: none
    std::uint64_t seed = 0;
    std::string stats; ///< file for the rows as JSON; "-" for standard output; empty: none
    bool quiet = false;
};

/// Prints one table per scene. Returns 1 if any of Duet's results is wrong or a ray leaked, 130 after an
/// interrupt signal. Throws Error for files and names that cannot be used.
int kernels(const KernelsOptions& options);

} // namespace duet::compare

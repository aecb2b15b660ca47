// `compare kernels`: how fast our ray kernels are, beside Embree's, on the same rays.
#pragma once

#include "common/program/render_program.h"
#include "compare/kernels/kernel_report.h"
#include "compare/kernels/kernel_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

struct KernelsOptions {
    std::vector<std::filesystem::path> meshes;
    std::vector<std::string> scenes{"alone", "room"}; ///< of bare meshes; a scene file is always alone
    std::vector<std::string> works;                   ///< of kWorks; empty: all
    std::vector<std::string> peers;                   ///< Embree's qualities (name_of), or "none"; empty: all
    std::string bvh = "default";                      ///< the quality of our hierarchy
    PictureSize size{1920, 1080};                     ///< one camera ray a pixel
    int threads = 0;                                  ///< of the rows for many threads; 0: all
    int repeats = 7;
    double seconds = 0.15;               ///< a measurement's length
    std::int64_t watertight = 1'000'000; ///< rays aimed from within closed scenes; 0: none
    std::uint64_t seed = 0;
    std::string stats; ///< a file for the rows as JSON, "-" for standard output, empty: none
    bool quiet = false;
};

/// camera, camera-bulk, bounce, shadow, build.
extern const std::vector<std::string> kWorks;

/// Prints a table a scene. Returns 1 where one of our answers is wrong or a ray leaked, 130 where a signal came. Throws
/// Error for files and names that cannot be used.
int kernels(const KernelsOptions& options);

} // namespace duet::compare

// `compare ladder`: both pipelines side by side, rung by rung, and where the difference of their pictures comes from.
#pragma once

#include "compare/pipeline.h"

#include <filesystem>
#include <string>

namespace duet::compare {

struct LadderOptions {
    std::filesystem::path scene, folder;
    PictureSize size{0, 0};    ///< 0: the scene's
    PipelineSettings settings; ///< an odd raytrace_spp is rounded up: the samples come in two halves
    std::string stats;         ///< a file for the figures of report.json, "-" for standard output, empty: none
    bool quiet = false;        ///< no progress bar, no table
};

/// Writes index.html, report.json, cause.png, the pictures of each rung (RUNG-QUANTITY-raster.png and -raytrace.png)
/// and of the ladder (picture-0.png to picture-7.png, change-1.png to change-7.png) to the folder, which is made if it
/// is missing; each whole or not at all. Returns the program's exit code: 0, or 130 where a signal came, and then
/// nothing is written. Throws Error for a scene or folder that cannot be used.
int ladder(const LadderOptions& options);

} // namespace duet::compare

// `compare ladder` compares both pipelines rung by rung and attributes the difference of their images to causes.
#pragma once

#include "compare/renderer.h"

#include <filesystem>
#include <string>

namespace duet::compare {

/// Holds the options of `compare ladder`.
struct LadderOptions {
    std::filesystem::path scene, folder;
    SceneOptions scene_options;
    ComparisonSettings settings; ///< an odd raytrace_spp is rounded up, because the samples form two halves
    std::string stats;         ///< file for a copy of report.json; "-" for standard output; empty: none
    bool quiet = false;        ///< no progress bar, no table
};

/// Writes index.html, report.json, cause.png, the images of each rung (RUNG-QUANTITY-raster.png and
/// -raytrace.png) and of the ladder (image-0.png to image-7.png, change-1.png to change-7.png) to the
/// folder, which is created if it is missing. Each file is written completely or not at all. Returns the
/// program's exit code: 0, or 130 after an interrupt signal, in which case nothing is written. Throws Error for
/// a scene or folder that cannot be used.
int ladder(const LadderOptions& options);

} // namespace duet::compare

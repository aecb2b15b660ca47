// `compare run`: renders one scene with both pipelines and writes one report.
#pragma once

#include "common/program/view_transform_options.h"
#include "compare/renderer.h"

#include <filesystem>
#include <string>

namespace duet::compare {

/// Holds the options of `compare run`.
struct RunOptions {
    std::filesystem::path scene, folder;
    SceneOptions scene_options;
    ComparisonSettings settings;
    ViewTransformOptions view_transform;
    std::string stats; ///< file for a copy of report.json; "-" for standard output; empty: none
    bool quiet = false;
};

/// Renders the scene with both pipelines and writes index.html, raster.png, raytrace.png, difference.png and
/// report.json to the folder, which is created if it is missing. Each file is written completely or not at all.
/// Returns the program's exit code: 0, or 130 after an interrupt signal, in which case nothing is written.
/// Throws Error for a scene or folder that cannot be used.
int run(const RunOptions& options);

} // namespace duet::compare

// `compare run`: one scene, both pipelines, one report.
#pragma once

#include "compare/pipeline.h"

#include <filesystem>
#include <string>

namespace duet::compare {

struct RunOptions {
    std::filesystem::path scene, folder;
    PictureSize size{0, 0}; ///< 0: the scene's
    PipelineSettings settings;
    std::string stats; ///< a file for the figures of report.json, "-" for standard output, empty: none
    bool quiet = false;
};

/// Renders the scene both ways and writes index.html, raster.png, raytrace.png, difference.png and report.json to the
/// folder, which is made if it is missing; each whole or not at all. Returns the program's exit code: 0, or 130 where a
/// signal came, and then nothing is written. Throws Error for a scene or folder that cannot be used.
int run(const RunOptions& options);

} // namespace duet::compare

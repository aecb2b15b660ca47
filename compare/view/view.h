// `compare view` opens a window that shows a scene, rendered live by both pipelines.
#pragma once

#include "common/program/render_program.h"
#include "common/program/view_transform_options.h"
#include "compare/renderer.h"

#include <filesystem>
#include <string>

namespace duet::compare {

/// Holds the options of `compare view`.
struct ViewOptions {
    std::filesystem::path scene;
    SceneOptions scene_options; ///< a size other than 0 × 0 is that of the images; else they fill the window
    ImageSize window{1600, 900};
    std::filesystem::path folder = ".";                                 ///< where screenshots and images are written
    ComparisonSettings settings{.raster_spp = 1, .raytrace_spp = 4096}; ///< the path tracer stops after these samples
    ViewTransformOptions view_transform;
    double measure = 0; ///< seconds of the camera's turn that is measured; 0: the window waits for its user
    std::string stats;  ///< file of the measurement as JSON; "-" for standard output; empty: none
};

/// Opens the window, and returns the program's exit code once it is closed. Throws Error for a scene that cannot be
/// used, without a screen, and in builds without the libraries of the window.
int view(const ViewOptions& options);

} // namespace duet::compare

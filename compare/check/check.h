// `compare check` renders scenes with both pipelines and checks what must hold for any valid scene.
#pragma once

#include "common/program/command_line.h"
#include "compare/check/scene_check.h"

#include <string>
#include <vector>

namespace duet::compare {

/// Holds the options of `compare check`.
struct CheckOptions {
    std::vector<std::string> scenes; ///< scene files; "-" stands for the names on standard input, one a line
    ImageSize size{0, 0}; ///< image size; 0 × 0: the scene's
    ComparisonSettings settings{.raster_spp = 1, .raytrace_spp = 4};
    int memory_limit = 0; ///< address space of this program in MiB; 0: not limited
};

/// Prints a JSON object on a line of its own for each scene, as soon as it is checked: `scene` (its name), `verdict`
/// ("ok", "failed" or "refused" if it cannot be loaded), `failure` and `details` (CheckResult; the error message of a
/// refused scene) and `seconds`. Returns 1 if a scene failed, else 2 if one was refused, else 0.
int check(const CheckOptions& options);

} // namespace duet::compare

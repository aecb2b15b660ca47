// `compare stop`: checks whether renders with --error and --time stop at those limits.
#pragma once

#include "common/program/command_line.h"
#include "compare/stop/measure_stop.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds the options of `compare stop`.
struct StopOptions {
    std::vector<std::filesystem::path> scenes;
    ImageSize size{0, 0}; ///< 0 × 0: the scene's aspect ratio, with a longer side of 96 pixels
    StopSettings settings;
    int reference_spp = 4096;
    std::filesystem::path references; ///< cache of compare bench; empty: default_reference_folder()
    std::string stats;                ///< file for the results as JSON; "-" for standard output; empty: none
    bool quiet = false;
};

/// These are the relative tolerances of the median error and of the time. The time may differ by one pass, if that is
/// longer.
inline constexpr double kErrorTolerance = 0.2, kTimeTolerance = 0.05;

/// Prints one row per scene. Returns 0; 1 if a scene without caustics misses the error by more than
/// kErrorTolerance, or a time is missed by more than kTimeTolerance and one pass; 130 after an interrupt
/// signal.
int stop(const StopOptions& options);

} // namespace duet::compare

// `compare stop`: do --error and --time end where they say?
#pragma once

#include "common/program/render_program.h"
#include "compare/stop/measure_stop.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

struct StopOptions {
    std::vector<std::filesystem::path> scenes;
    PictureSize size{0, 0}; ///< 0 × 0: the scene's shape, its longer side 96 pixels
    StopSettings settings;
    int reference_spp = 4096;
    std::filesystem::path references; ///< the cache of compare bench; empty: default_reference_folder()
    std::string stats;                ///< the figures as JSON, "-": standard output, empty: none
    bool quiet = false;
};

/// By how much the median error may miss the one asked for, and the time the one asked for (or one pass).
inline constexpr double kErrorTolerance = 0.2, kTimeTolerance = 0.05;

/// Prints a row a scene. Returns 0; 1 where a scene without caustics misses the error by more than kErrorTolerance, or
/// a time is missed by more than kTimeTolerance and one pass; 130 where a signal came.
int stop(const StopOptions& options);

} // namespace duet::compare

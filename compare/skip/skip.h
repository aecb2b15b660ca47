// `compare skip`: what each skip saves, and proof that the picture is the same.
#pragma once

#include "compare/pipeline.h"
#include "compare/skip/measure_skip.h"

#include <filesystem>

namespace duet::compare {

struct SkipOptions {
    std::filesystem::path scene;
    PictureSize size{0, 0}; ///< 0 x 0: the scene's shape, its longer side 128 pixels
    SkipSettings settings;
    MeasureOptions measure;
    std::vector<std::string> only; ///< PIPELINE/NAME, or NAME in both; empty: all
    std::string stats;             ///< a file for the figures as JSON, "-" for standard output, empty: none
    bool quiet = false;            ///< no progress bar, no table
};

/// Prints a table of all skips. Returns 1 where a skip is not proved to leave the picture as it is, 130 where a signal
/// came. Throws Error for a scene or a name that cannot be used.
int skip(const SkipOptions& options);

} // namespace duet::compare

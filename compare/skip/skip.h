// `compare skip`: measures what each skip saves, and proves that the image stays the same.
#pragma once

#include "compare/renderer.h"
#include "compare/skip/measure_skip.h"

#include <filesystem>

namespace duet::compare {

/// Holds the options of `compare skip`.
struct SkipOptions {
    std::filesystem::path scene;
    ImageSize size{0, 0}; ///< 0 × 0: the scene's aspect ratio, with a longer side of 128 pixels
    ComparisonSettings settings{.raster_spp = 4, .raytrace_spp = 4};
    SkipMeasureSettings measure;
    std::vector<std::string> only; ///< PIPELINE/NAME, or NAME for both pipelines; empty: all
    std::string stats;             ///< file for the results as JSON; "-" for standard output; empty: none
    bool quiet = false;            ///< no progress bar, no table
};

/// Prints a table of all skips. Returns 1 if a skip is not proved to preserve the image, 130 after an interrupt
/// signal. Throws Error for a scene or a name that cannot be used.
int skip(const SkipOptions& options);

} // namespace duet::compare

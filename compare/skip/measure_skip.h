// This file measures what one skip saves, and whether it preserves the image.
#pragma once

#include "compare/skip/bias_test.h"
#include "compare/skip/skip_cases.h"

#include <optional>

namespace duet::compare {

/// Says what one skip saves, and whether the skip changes the image.
struct SkipMeasurement {
    struct Seconds {
        double median = 0, min = 0;
    };
    Seconds with, without;          ///< wall-clock times of render() alone, over the repeats
    int image_pairs = 0;            ///< image pairs compared bit by bit: one per repeat, each with its own seed
    std::int64_t pixels_differ = 0; ///< total over all pairs
    std::int64_t rays_saved = 0;    ///< indirect and shadow rays, total over all pairs
    std::string reason;             ///< what the pipeline reports about the skip: why, or how many; empty: nothing
    std::optional<BiasTest> bias;   ///< present if bits differ and the skip is to be judged by its bias
    bool proved = false;
};

/// Says how a skip is measured.
struct SkipMeasureSettings {
    int repeats = 5;
    std::uint64_t seed = 0;
    double bias = 0.001; ///< relative bias that must be detectable
    double budget = 120; ///< time limit in seconds for the bias test; if it does not suffice, the skip is not proved
};

/// Renders the view with and without the skip in turns. If stopped by `control`, returns an incomplete result.
SkipMeasurement measure_skip(const SkipCase& skip, const View& view, const SkipMeasureSettings& options,
                             Control& control);

} // namespace duet::compare

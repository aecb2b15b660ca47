// What one skip saves, and whether it leaves the picture as it is.
#pragma once

#include "compare/skip/bias_test.h"
#include "compare/skip/skip_cases.h"

#include <optional>

namespace duet::compare {

struct SkipMeasurement {
    struct Seconds {
        double median = 0, min = 0;
    };
    Seconds with, without;          ///< of the repeats, wall-clock, render() alone
    int pictures = 0;               ///< pairs compared bit by bit: one a repeat, each of its own seed
    std::int64_t pixels_differ = 0; ///< over all of them
    std::int64_t rays_saved = 0;    ///< indirect and shadow rays, over all of them
    std::string reason;             ///< what the pipeline says of the skip: why, or how many; empty: nothing
    std::optional<BiasTest> bias;   ///< where bits differ and the skip is to be judged by its bias
    bool proved = false;
};

struct MeasureOptions {
    int repeats = 5;
    std::uint64_t seed = 0;
    double bias = 0.001; ///< relative, that must be detectable
    double budget = 120; ///< seconds for that, at most; where it does not suffice the skip is not proved
};

/// Renders the view with and without the skip in turns. Stopped by the control it returns what it has.
SkipMeasurement measure_skip(const SkipCase& skip, const View& view, const MeasureOptions& options, Control& control);

} // namespace duet::compare

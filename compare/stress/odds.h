// The errors of statistical trials: how unlikely what was seen is, whatever the number of trials.
#pragma once

#include "compare/metrics/normal.h"

#include <cmath>
#include <cstdint>

namespace duet::compare {

/// The odds, as −log10, that the lowest of `tests` independent p-values is as low as this: a bound of 6 on it gives a
/// row odds of a false alarm of 1e-6.
inline double family_odds(double p, std::int64_t tests) {
    const double odds = -std::log10(sidak(p, static_cast<double>(tests)));
    return odds < 0 ? 0 : odds; // NaN stays
}

} // namespace duet::compare

// This header declares the errors of statistical trials: how unlikely a result is, independent of the number of
// trials.
#pragma once

#include "compare/metrics/normal_distribution.h"

#include <cmath>
#include <cstdint>

namespace duet::compare {

/// Returns −log10 of the probability that the lowest of `tests` independent p-values is this low. A bound of 6 gives
/// a row a false alarm probability of 1e-6.
inline double family_log_p_value(double p, std::int64_t tests) {
    const double odds = -std::log10(sidak(p, static_cast<double>(tests)));
    return odds < 0 ? 0 : odds; // NaN stays NaN
}

} // namespace duet::compare

// This file computes errors at equal time, and times at equal error. Efficiency predicts them only for independent
// samples.
#pragma once

#include "compare/bench/measure.h"

#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// Returns the mean squared error of one renderer at time `seconds`, interpolated linearly in the logarithms of time
/// and error between its measurements. Returns nothing outside the measured times. If `rest` is set, the error omits
/// the excluded rectangles. The uncertainty is the larger one of the two neighboring measurements; it combines the
/// uncertainty of the error with that of the time, converted by the slope between them. Rows with `counted` = false are
/// ignored. Without `sampler`, all samplers of the technique are used (for a peer these are its settings).
std::optional<Estimate> error_at(const std::vector<Measurement>& rows, const std::string& technique,
                                 const std::optional<std::string>& sampler, double seconds, bool rest);

/// Holds the error of one renderer at one time.
struct EqualTimeRow {
    double seconds = 0;
    std::string name;
    std::optional<Estimate> mse, rest_mse;
    std::optional<Estimate> to_peer, rest_to_peer; ///< the renderer's error over the peer's: below 1 is better
};

/// Returns every renderer at each of the times, in order, compared with `peer` unless that is empty.
std::vector<EqualTimeRow> at_equal_times(const std::vector<Measurement>& rows,
                                         const std::vector<double>& equal_times_seconds, const std::string& peer);

/// A Dominance says how many times as fast as the path tracer a renderer is, at the renderer's own error.
struct Dominance {
    Estimate ratio;       ///< the path tracer's time to the same relMSE over the renderer's; above 1 is faster
    bool at_most = false; ///< the path tracer's fastest measurement is more accurate, so `ratio` is an upper bound
};

/// Returns the dominance of one of the rows over those of the technique `path` with its fastest sampler. The path
/// tracer's time is interpolated linearly in the logarithms between its measurements. Beyond the most accurate
/// measurement, its error is assumed to fall as 1 / time, as that of independent samples does. Returns nothing where
/// `path` was not measured, and for rows of `path` itself.
std::optional<Dominance> dominance(const std::vector<Measurement>& rows, const Measurement& row);

} // namespace duet::compare

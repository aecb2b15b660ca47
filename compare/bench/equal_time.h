// Errors at equal time. Efficiency predicts them only for independent samples.
#pragma once

#include "compare/bench/measure.h"

#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// Returns the mean squared error of one renderer at time `seconds`, interpolated linearly in the logarithms
/// of time and error between its measurements. Returns nothing outside the measured times. If `rest` is set,
/// the error omits the excluded rectangles. The uncertainty is the larger one of the two neighboring
/// measurements; it combines the uncertainty of the error with that of the time, converted by the slope between
/// them. Rows that are not counted are ignored. Without `sampler`, all samplers of the technique are used (for
/// a peer these are its settings).
std::optional<Estimate> error_at(const std::vector<Measurement>& rows, const std::string& technique,
                                 const std::optional<std::string>& sampler, double seconds, bool rest);

/// One renderer at one time.
struct EqualTimeRow {
    double seconds = 0;
    std::string name;
    std::optional<Estimate> mse, rest_mse;
    std::optional<Estimate> to_peer, rest_to_peer; ///< its error over the peer's: below 1 is better
};

/// Returns every renderer at each of the times, in order, compared with `peer` unless that is empty.
std::vector<EqualTimeRow> at_equal_times(const std::vector<Measurement>& rows,
                                         const std::vector<double>& equal_times_seconds, const std::string& peer);

} // namespace duet::compare

// Errors at equal time: the question that efficiency only answers for independent samples.
#pragma once

#include "compare/bench/measure.h"

#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// The mean squared error of one contender at a moment, by linear interpolation of logarithms between its measurements;
/// empty before the first and after the last: nothing is extrapolated. `rest`: without the excluded rectangles. The
/// uncertainty is the larger of the two neighbours', of error and of time (which the slope between them makes one of
/// error). Rows that are not counted are left out. Without `sampler`: of all its samplers (a peer's settings).
std::optional<Estimate> error_at(const std::vector<Measurement>& rows, const std::string& technique,
                                 const std::optional<std::string>& sampler, double seconds, bool rest);

/// One contender at one moment.
struct EqualTimeRow {
    double seconds = 0;
    std::string name;
    std::optional<Estimate> mse, rest_mse;
    std::optional<Estimate> to_peer, rest_to_peer; ///< its error over the peer's: below 1 is better
};

/// Every contender at each of the moments, in order; compared with `peer` unless that is empty.
std::vector<EqualTimeRow> at_equal_times(const std::vector<Measurement>& rows, const std::vector<double>& moments,
                                         const std::string& peer);

} // namespace duet::compare

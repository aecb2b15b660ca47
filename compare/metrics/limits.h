// This file defines limits on metrics, as given by --fail-above.
#pragma once

#include "compare/metrics/image_metrics.h"

#include <string>
#include <vector>

namespace duet::compare {

/// Holds a limit that a metric must not exceed.
struct Limit {
    std::string metric; ///< a name that metric_values() uses
    double value = 0;
};

/// Parses "METRIC=VALUE". Throws Error, with a list of the metrics, if METRIC is unknown or VALUE is not a
/// finite number.
Limit parse_limit(const std::string& text);
/// Returns all metrics' names as "mse, rmse, …".
std::string metric_names();

/// Returns one sentence for each exceeded limit, which says by how much. A value exceeds its limit if it is
/// above it, or below it if less is worse. NaN exceeds every limit.
std::vector<std::string> exceeded(const std::vector<Limit>& limits, const std::vector<MetricValue>& found);

} // namespace duet::compare

// Limits of figures: what --fail-above says.
#pragma once

#include "compare/metrics/image_metrics.h"

#include <string>
#include <vector>

namespace duet::compare {

struct Limit {
    std::string metric; ///< one of figures()
    double value = 0;
};

/// "METRIC=VALUE". Throws Error, which lists the metrics, for an unknown one, and where VALUE is no finite number.
Limit parse_limit(const std::string& text);
/// "mse, rmse, …".
std::string metric_names();

/// One sentence for each limit that is exceeded, and by how much: by a value above it, or below it where less is worse.
/// NaN exceeds every limit.
std::vector<std::string> exceeded(const std::vector<Limit>& limits, const std::vector<Figure>& found);

} // namespace duet::compare

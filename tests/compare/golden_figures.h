// This header reads tests/golden/image-metrics.csv: metrics that other programs compute for the pairs of
// test_pictures.h.
#pragma once

#include "common/system/error.h"

#include <fstream>
#include <sstream>
#include <string>

namespace duet::compare {

/// Throws Error if the file has no line `pair,metric,…`.
inline double golden_figure(const std::string& pair, const std::string& metric) {
    std::ifstream file(std::string(DUET_SOURCE_DIR) + "/tests/golden/image-metrics.csv");
    const std::string wanted = pair + "," + metric + ",";
    for (std::string line; std::getline(file, line);)
        if (line.rfind(wanted, 0) == 0) return std::stod(line.substr(wanted.size()));
    throw Error(message("image-metrics.csv has no line ", wanted));
}

} // namespace duet::compare

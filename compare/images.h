// `compare images`: the figures of two picture files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

struct ImagesOptions {
    std::filesystem::path a, reference;
    std::vector<std::string> limits; ///< "METRIC=VALUE"
    std::string stats;               ///< a file for the figures as JSON, "-" for standard output, empty: none
    bool quiet = false;              ///< no table
};

/// Prints a table of metrics of A against the reference. Returns 1 where a metric is over its limit (psnr: under it) or
/// no number, else 0. Throws Error for files and limits that cannot be used.
int compare_images(const ImagesOptions& options);

} // namespace duet::compare

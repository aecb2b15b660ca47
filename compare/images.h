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
    bool decode = false;             ///< 8-bit files are decoded, and all figures are of linear values
    int threads = 0;                 ///< 0: all
    std::filesystem::path folder;    ///< for the page, its figures and difference.png; empty: none
};

/// Prints a table of the figures of A against the reference (compare/metrics/image_metrics.h) and writes index.html,
/// difference.png and report.json to the folder, which is made if it is missing. Returns 1 where a metric is beyond its
/// limit or no number, else 0. Alpha is not compared: pixels that have one other than 1 are counted. Variances are the
/// channels variance.R, variance.G and variance.B of an EXR file. Throws Error for files and limits that cannot be
/// used: for sizes that differ, an 8-bit file against a float one without `decode`, a limit of a z-test without
/// variances.
int compare_images(const ImagesOptions& options);

} // namespace duet::compare

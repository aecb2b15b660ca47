// This file declares `compare images`, which computes error metrics of two image files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds the options of `compare images`.
struct ImagesOptions {
    std::filesystem::path a, reference;
    std::vector<std::string> limits; ///< "METRIC=VALUE"
    std::string stats;               ///< file for the metrics as JSON; "-" for standard output; empty: none
    bool quiet = false;              ///< prints no table
    bool decode = false;             ///< decodes 8-bit files, so that all metrics are of linear values
    int threads = 0;                 ///< 0: all hardware threads
    std::filesystem::path folder;    ///< output folder for the page, report.json and difference.png; empty: none
};

/// Prints a table of the metrics of image A against the reference (compare/metrics/image_metrics.h). If a
/// folder is given, creates it if it is missing and writes index.html, difference.png and report.json there.
/// Returns 1 if a metric exceeds its limit or is not a number, else 0. Alpha is not compared; pixels whose
/// alpha is not 1 are counted. Variances are read from the channels variance.R, variance.G and variance.B of an
/// EXR file. Throws Error for files and limits that cannot be used: images of different sizes, an 8-bit file
/// against a float file without `decode`, or a limit on a z-test metric without variances.
int compare_images(const ImagesOptions& options);

} // namespace duet::compare

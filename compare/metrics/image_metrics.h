// All figures of a pair of pictures.
#pragma once

#include "common/image/image_file.h"
#include "compare/metrics/error_metrics.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/z_test.h"

#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

using Encoding = PixelFile::Encoding;

struct ImageMetrics {
    ErrorMetrics errors;
    double ssim = 0;
    HdrFlip flip;           ///< of encoded pictures FLIP: no exposures
    std::optional<ZTest> z; ///< where a variance is known
};

/// The figures of A against the reference, both as stored: linear radiance, or sRGB-encoded values in [0, 1]. Of the
/// latter relMSE, SMAPE and the mean signed error compare the decoded values, all else the values as they are. The
/// z-test is the caller's. Throws Error where the pictures differ in size.
ImageMetrics image_metrics(const ImageRgb& a, const ImageRgb& reference, Encoding encoding, int threads = 0);

/// Encoded values to linear ones.
ImageRgb decoded(const ImageRgb& image);

/// One number of them.
struct Figure {
    std::string name; ///< as in the JSON and in METRIC=VALUE
    double value = 0;
    std::string meaning;
    bool less_is_worse = false;
};

/// Those that can have a limit, in a table's order; the names are always the same, the values of a z-test that was not
/// made NaN.
std::vector<Figure> figures(const ImageMetrics& metrics);

} // namespace duet::compare

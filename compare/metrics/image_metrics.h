// This file computes all metrics of a pair of images.
#pragma once

#include "common/image/image_file.h"
#include "compare/metrics/error_metrics.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/z_test.h"

#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

using Encoding = StoredImage::Encoding;

/// Holds all metrics of two images.
struct ImageMetrics {
    ErrorMetrics errors;
    double ssim = 0;
    HdrFlip flip;           ///< HDR-FLIP of linear images; FLIP of encoded images, with no exposures
    std::optional<ZTest> z; ///< present if a variance is known
};

/// Computes the metrics of A against the reference. Both hold linear radiance or sRGB-encoded values in [0, 1],
/// as `encoding` says. For encoded images, relMSE, SMAPE and the mean signed error compare the decoded values;
/// all other metrics compare the encoded values. The caller adds the z-test. Throws Error if the images differ
/// in size.
ImageMetrics image_metrics(const ImageRgb& a, const ImageRgb& reference, Encoding encoding, int threads = 0);

/// Converts 8-bit values to fractions of 255.
ImageRgb encoded_values(const Image<Rgba8>& image);
/// Decodes sRGB-encoded values to linear ones.
ImageRgb decoded(const ImageRgb& image);

/// A MetricValue is one metric as a number with a name.
struct MetricValue {
    std::string name; ///< name in the JSON and in METRIC=VALUE
    double value = 0;
    std::string meaning;
    bool higher_is_better = false;
};

/// Returns the metrics that can have a limit, in the order of the table. The list always has the same names;
/// the z-test's values are NaN if no z-test was made.
std::vector<MetricValue> metric_values(const ImageMetrics& metrics);

} // namespace duet::compare

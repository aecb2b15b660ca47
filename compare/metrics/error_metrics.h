// This file computes error metrics between two images.
#pragma once

#include "common/image/image.h"

#include <cstdint>

namespace duet::compare {

/// The denominator of relative errors contains this term, which avoids division by zero and keeps dark pixels of the
/// reference from dominating.
inline constexpr double kRelativeFloor = 0.01;
/// Returns the relative error of a squared error (Rousselle, Knaus and Zwicker 2011, §5).
inline double relative_square(double square, double reference) { return square / (sqr(reference) + kRelativeFloor); }

/// Holds the differences of image A from the reference B, computed on the values as given, in double precision. Means
/// are over all channels of all pixels that are finite in both images; the other pixels are counted. If no pixel is
/// left, every mean is NaN.
struct ErrorMetrics {
    double mse = 0;                    ///< mean of (a − b)²
    double rmse = 0;                   ///< square root of mse
    double mae = 0;                    ///< mean of |a − b|
    double psnr = 0;                   ///< 10 log₁₀(1 / mse) in dB, with peak value 1; infinite for equal images
    double relmse = 0;                 ///< mean of (a − b)² / (b² + 0.01) (Rousselle, Knaus and Zwicker 2011, §5)
    double relmse_trimmed = 0;         ///< relmse without the worst 0.1 % of the pixels (rounded down)
    double smape = 0;                  ///< mean of |a − b| / (|a| + |b| + 0.01) (Vogels et al. 2018, §5.1)
    Rgbd mean_signed_error;            ///< mean of a − b, per channel
    double worst = 0;                  ///< largest |a − b| of any channel
    int worst_x = 0, worst_y = 0;      ///< the first pixel with the worst difference
    std::int64_t pixels = 0;           ///< pixels that are finite in both images
    std::int64_t nan_a = 0, nan_b = 0; ///< pixels with a NaN channel
    std::int64_t infinite_a = 0, infinite_b = 0;     ///< pixels with an infinite channel
    std::int64_t non_finite_a = 0, non_finite_b = 0; ///< pixels with a NaN or infinite channel
};

/// Computes the metrics of A against the reference B. Throws Error if the images differ in size.
ErrorMetrics error_metrics(const ImageRgb& a, const ImageRgb& b);

} // namespace duet::compare

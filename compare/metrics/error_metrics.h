// How far one picture is from another, in numbers.
#pragma once

#include "common/image/image.h"

#include <cstdint>

namespace duet::compare {

/// Differences of picture A from the reference B, over the values given, computed in double. Means run over all pixels
/// and channels but those of pixels that are not finite in A or in B: these are counted. Where no pixel is left, every
/// mean is NaN.
struct ErrorMetrics {
    double mse = 0;                    ///< mean of (a − b)²
    double rmse = 0;                   ///< its square root
    double mae = 0;                    ///< mean of |a − b|
    double psnr = 0;                   ///< 10 log₁₀(1 / mse) in dB: the peak is 1; infinite for equal pictures
    double relmse = 0;                 ///< mean of (a − b)² / (b² + 0.01) (Rousselle, Knaus and Zwicker 2011, §5)
    double relmse_trimmed = 0;         ///< the same without the worst 0.1 % of the pixels (rounded down)
    double smape = 0;                  ///< mean of |a − b| / (|a| + |b| + 0.01) (Vogels et al. 2018, §5.1)
    Rgbd mean_signed_error;            ///< mean of a − b, by channel
    double worst = 0;                  ///< largest |a − b| of any channel …
    int worst_x = 0, worst_y = 0;      ///< … and the first pixel that has it
    std::int64_t pixels = 0;           ///< pixels that count
    std::int64_t nan_a = 0, nan_b = 0; ///< pixels with a NaN channel
    std::int64_t infinite_a = 0, infinite_b = 0;     ///< pixels with an infinite channel
    std::int64_t non_finite_a = 0, non_finite_b = 0; ///< pixels with either
};

/// Throws Error where the pictures differ in size.
ErrorMetrics error_metrics(const ImageRgb& a, const ImageRgb& b);

} // namespace duet::compare

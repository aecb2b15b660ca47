// This file computes FLIP, the perceived difference of two images when alternating between them.
#pragma once

#include "common/image/image.h"

namespace duet::compare {

/// These are the paper's viewing conditions: a screen 0.7 m wide with 3840 pixels, viewed from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 3840 * 3.14159265358979323846 / 180; // 67.02

/// Holds an error map in [0, 1] and its pooled values. A pixel that is not finite in either image is set to black in
/// both images when its neighbors are filtered. It is NaN in the map and excluded from the pooled values, which are NaN
/// if no pixel is left.
struct Flip {
    ImageFloat map;
    double mean = 0;
    /// The errors of the pixels up to these values add up to one half, one quarter and three quarters of the sum of all
    /// errors.
    double weighted_median = 0, first_quartile = 0, third_quartile = 0;
    double min = 0, max = 0;
};

/// Computes FLIP (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images") of two images of
/// sRGB-encoded values, clamped to [0, 1]. `pixels_per_degree` is the number of pixels per degree of visual angle.
/// Throws Error if the images differ in size. The result is bitwise identical for any number of threads (0: all).
Flip flip(const ImageRgb& test, const ImageRgb& reference, double pixels_per_degree = kFlipPixelsPerDegree,
          int threads = 0);

/// Holds the maximum of the FLIP error over all exposures, per pixel.
struct HdrFlip : Flip {
    double start_exposure = 0, stop_exposure = 0; ///< in stops: radiance is scaled by 2^exposure
    int exposures = 0;                            ///< number of exposures, evenly spaced from start to stop
};

/// Computes HDR-FLIP (Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images") of two images
/// of linear radiance; negative values count as 0. The exposures are about one stop apart. The first maps the
/// reference's maximum luminance to 0.85 of white on the ACES curve, and the last one the median. If the median is 0,
/// the median of the positive luminances is used. Parameters and errors are those of flip().
HdrFlip hdr_flip(const ImageRgb& test, const ImageRgb& reference, double pixels_per_degree = kFlipPixelsPerDegree,
                 int threads = 0);

} // namespace duet::compare

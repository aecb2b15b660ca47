// FLIP: how different two pictures look to someone who alternates between them.
#pragma once

#include "common/image/image.h"

namespace duet::compare {

/// A screen 0.7 m wide with 3840 pixels seen from 0.7 m: the paper's observer.
inline constexpr double kFlipPixelsPerDegree = 3840 * 3.14159265358979323846 / 180; // 67.02

/// A map of errors in [0, 1] and its pooled values. A pixel that is not finite in either picture is black in both for
/// its neighbours, NaN in the map, and left out of the values, which are NaN where no pixel is left.
struct Flip {
    ImageFloat map;
    double mean = 0;
    /// Below it lie the pixels that hold half of the sum of all errors; the quartiles: a quarter, three quarters.
    double weighted_median = 0, first_quartile = 0, third_quartile = 0;
    double min = 0, max = 0;
};

/// FLIP of two pictures of sRGB-encoded values in [0, 1] (clamped to it), seen at so many pixels a degree of visual
/// angle. Throws Error where the pictures differ in size. The same bits for any number of threads (0: all).
/// Andersson et al. 2020, «FLIP: A Difference Evaluator for Alternating Images».
Flip flip(const ImageRgb& test, const ImageRgb& reference, double pixels_per_degree = kFlipPixelsPerDegree,
          int threads = 0);

/// The largest error of any exposure, pixel by pixel.
struct HdrFlip : Flip {
    double start_exposure = 0, stop_exposure = 0; ///< in stops: radiance is scaled by 2^exposure
    int exposures = 0;                            ///< evenly from start to stop
};

/// FLIP of two pictures of linear radiance (below 0: taken as 0), over the exposures which take the reference's
/// brightest and its median luminance to 0.85 of white on the ACES curve, about a stop apart. Where the median is 0
/// it is that of the luminances above 0. Otherwise as flip().
/// Andersson et al. 2021, «Visualizing Errors in Rendered High Dynamic Range Images».
HdrFlip hdr_flip(const ImageRgb& test, const ImageRgb& reference, double pixels_per_degree = kFlipPixelsPerDegree,
                 int threads = 0);

} // namespace duet::compare

// The filters of FLIP: how much detail an observer sees, and where an edge or a point is.
#pragma once

#include <array>
#include <vector>

namespace duet::compare {

/// An odd number of taps; the middle one is for the pixel itself.
using Kernel = std::vector<float>;

/// A two-dimensional filter as two of one dimension, applied to one channel of a picture.
struct SeparableFilter {
    std::size_t channel; ///< of Y, Cx, Cz
    Kernel horizontal, vertical;
};

/// The eight filters, by what they give.
enum FlipFilter : std::size_t {
    kAchromatic,
    kRedGreen,
    kBlueYellowNarrow, ///< blue-yellow is the sum of two Gaussians
    kBlueYellowWide,
    kEdgeX,
    kEdgeY,
    kPointX,
    kPointY,
    kFlipFilters
};

/// Contrast sensitivity and feature detection for an observer who sees so many pixels in a degree of visual angle
/// (above 0; 67 and less give at most 21 taps). Andersson et al. 2020, §4.1.1 and §4.2.1.
std::array<SeparableFilter, kFlipFilters> flip_filters(double pixels_per_degree);

} // namespace duet::compare

// This file declares the filters of FLIP: contrast sensitivity, edge detection and point detection.
#pragma once

#include <array>
#include <vector>

namespace duet::compare {

/// A Kernel is an odd number of filter taps, centered on the pixel.
using Kernel = std::vector<float>;

/// A SeparableFilter is a two-dimensional filter of one image channel as the product of two one-dimensional filters.
struct SeparableFilter {
    std::size_t channel; ///< index into Y, Cx, Cz
    Kernel horizontal, vertical;
};

/// These are the eight filters, named by their output.
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

/// Returns the contrast sensitivity and feature detection filters (Andersson et al. 2020, §4.1.1 and §4.2.1) for an
/// observer with `pixels_per_degree` pixels per degree of visual angle, above 0; up to 67 gives at most 21 taps.
std::array<SeparableFilter, kFlipFilters> flip_filters(double pixels_per_degree);

} // namespace duet::compare

// This file computes the difference of two images in false color, for a window.
#pragma once

#include "common/image/image.h"
#include "common/image/view_transform.h"

#include <cstdint>
#include <vector>

namespace duet::compare {

/// Holds the difference of two images in false color.
struct ImageComparison {
    std::vector<std::uint8_t> bytes{}; ///< as display_bytes() returns them
    double figure = 0;                 ///< signed difference: luminance shown as full orange or blue; FLIP: mean
};

/// Returns a − b in luminance: blue where a is darker, orange where it is brighter. Like flip_comparison(), it throws
/// Error for images of different sizes.
ImageComparison signed_comparison(const ImageRgb& a, const ImageRgb& b, int threads);
/// Returns FLIP of both images as they are shown: 0 is near white, 1 orange.
ImageComparison flip_comparison(const ImageRgb& a, const ImageRgb& b, const ViewTransform& transform, int threads);

} // namespace duet::compare

// This file defines excluded rectangles of an image. A second error measure omits them, for example a light whose edge
// dominates the error.
#pragma once

#include "common/image/image.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace duet::compare {

/// An ExcludedRectangle is [x0, x1) × [y0, y1) from the upper left corner, in pixels or in fractions of the image size.
struct ExcludedRectangle {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool fractions = false;
};
/// Parses "x0,y0,x1,y1". If no number is above 1, they are fractions of width and height, else whole pixels.
/// Throws Error for other text, negative numbers, and rectangles without area.
ExcludedRectangle parse_excluded_rectangle(std::string_view text);

/// Returns 1 for each pixel that counts, and 0 for each pixel in a rectangle. A rectangle in fractions contains the
/// pixels whose centers it contains. Throws Error if a rectangle in pixels extends beyond the image, and if no pixel is
/// left.
Image<std::uint8_t> counted_pixels(const std::vector<ExcludedRectangle>& rectangles, int width, int height);

} // namespace duet::compare

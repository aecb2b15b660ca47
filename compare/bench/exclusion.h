// Rectangles of a picture that a second account of the error leaves out: a lamp whose edge would drown all else.
#pragma once

#include "common/image/image.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace duet::compare {

/// A rectangle in pixels or in parts of the picture: [x0, x1) × [y0, y1) from the upper left corner.
struct ExcludedRectangle {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool fractions = false;
};
/// "x0,y0,x1,y1". Where none is above 1 they are parts of width and height, else whole pixels. Throws Error for other
/// text, numbers that are negative, and rectangles without area.
ExcludedRectangle parse_excluded_rectangle(std::string_view text);

/// 1 for each pixel that counts, 0 for those in a rectangle (of parts: whose centre is in it). Throws Error where a
/// rectangle of pixels reaches beyond the picture, and where nothing is left.
Image<std::uint8_t> counted_pixels(const std::vector<ExcludedRectangle>& rectangles, int width, int height);

} // namespace duet::compare

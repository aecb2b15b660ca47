// Lab 01: lines.
#pragma once

#include "common/image/image.h"
#include "tests/grading/lab.h"

#include <cstdint>
#include <vector>

namespace duet::lab {

/// A pixel: column x from the left, row y from the top. Coordinates are within ±2^15, also outside of the image.
struct Pixel {
    std::int32_t x = 0, y = 0;
};

/// A line of pixels from a to b. Both may be the same pixel.
struct Line {
    Pixel a, b;
    Rgb color;
};

/// How many pixels the line from a to b has: one for each column or one for each row, whichever are more.
int pixel_count(Pixel a, Pixel b);

/// (b - a) × (p - a) = (b.x - a.x)·(p.y - a.y) - (b.y - a.y)·(p.x - a.x), exact: 0 where p lies on the line through a
/// and b.
std::int64_t line_error(Pixel a, Pixel b, Pixel p);

/// The pixels of the line in their order, from a to b, both included. If the line has a pixel for each column, that is
/// the one whose center is nearest to the line, and of two that are equally near the one with the smaller y. Likewise
/// for rows: of two the one with the smaller x. So the line from b to a has the same pixels in reverse order.
std::vector<Pixel> line_pixels(Pixel a, Pixel b);

/// The lines in their order, each over those before, on the background. Pixels outside of the image are left out; those
/// inside are the same as those of line_pixels.
ImageRgb draw_lines(const std::vector<Line>& lines, int width, int height, Rgb background);

} // namespace duet::lab

DUET_LAB(pixel_count, line_error, line_pixels, draw_lines)

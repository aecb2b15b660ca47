// Straight lines of pixels.
#pragma once

#include "common/image/image.h"

#include <cstdlib>

namespace duet::lesson {

/// Draws the pixels nearest to the line from (x0, y0) to (x1, y1), both ends included; those outside the image are left
/// out. Only integers: the error after each step is kept as a whole number. (Bresenham 1965, "Algorithm for Computer
/// Control of a Digital Plotter"; the symmetric form for all eight directions is that of tinyrenderer, lesson 1)
inline void draw_line(ImageRgb& image, int x0, int y0, int x1, int y1, Rgb color) {
    const int dx = std::abs(x1 - x0), dy = -std::abs(y1 - y0);
    const int step_x = x0 < x1 ? 1 : -1, step_y = y0 < y1 ? 1 : -1;
    int error = dx + dy;
    for (;;) {
        if (x0 >= 0 && x0 < image.width() && y0 >= 0 && y0 < image.height()) image(x0, y0) = color;
        if (x0 == x1 && y0 == y1) return;
        const int doubled = 2 * error;
        if (doubled >= dy) error += dy, x0 += step_x;
        if (doubled <= dx) error += dx, y0 += step_y;
    }
}

} // namespace duet::lesson

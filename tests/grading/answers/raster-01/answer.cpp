// Lines by Bresenham's error, one of the two axes leading. Where two pixels are equally near, the lower one is taken.
#include "raster/lessons/01-lines/lab.h"

#include <algorithm>
#include <cstdlib>

namespace duet::lab {

int pixel_count(Pixel a, Pixel b) {
    const int columns = std::abs(b.x - a.x);
    const int rows = std::abs(b.y - a.y);
    return std::max(columns, rows) + 1;
}

std::int64_t line_error(Pixel a, Pixel b, Pixel p) {
    const std::int64_t line_x = b.x - a.x, line_y = b.y - a.y;
    const std::int64_t to_x = p.x - a.x, to_y = p.y - a.y;
    return line_x * to_y - line_y * to_x;
}

/// Calls visit(x, y) for the pixels of the line from a to b, in order.
template <typename Visit> void walk(Pixel a, Pixel b, Visit visit) {
    const int dx = std::abs(b.x - a.x), dy = std::abs(b.y - a.y);
    const int step_x = b.x > a.x ? 1 : -1;
    const int step_y = b.y > a.y ? 1 : -1;
    const bool steep = dy > dx;
    const int leading = steep ? dy : dx;
    const int other = steep ? dx : dy;
    // A tie goes to the smaller coordinate: to the next one only if the other axis falls.
    const bool tie_moves = (steep ? step_x : step_y) < 0;
    int x = a.x, y = a.y;
    int error = 0; // how far the line is ahead of the pixel in the other axis, times leading
    for (int i = 0; i <= leading; ++i) {
        visit(x, y);
        error += other;
        const bool move = 2 * error > leading || (2 * error == leading && tie_moves);
        if (move) error -= leading;
        if (steep) {
            y += step_y;
            if (move) x += step_x;
        } else {
            x += step_x;
            if (move) y += step_y;
        }
    }
}

std::vector<Pixel> line_pixels(Pixel a, Pixel b) {
    std::vector<Pixel> pixels;
    walk(a, b, [&](int x, int y) { pixels.push_back({x, y}); });
    return pixels;
}

ImageRgb draw_lines(const std::vector<Line>& lines, int width, int height, Rgb background) {
    ImageRgb image(width, height, background);
    for (const Line& line : lines)
        walk(line.a, line.b, [&](int x, int y) {
            if (x < 0 || x >= width) return;
            if (y < 0 || y >= height) return;
            image(x, y) = line.color;
        });
    return image;
}

} // namespace duet::lab

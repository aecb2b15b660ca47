// Figures that show single pixels.
#pragma once

#include "raster/lessons/01-lines/line.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace duet::lesson {

/// A color of the rainbow: red at 0, green at 1/3, blue at 2/3, and red again at 1.
inline Rgb rainbow(float t) {
    const auto channel = [t](float phase) { return sqr(0.5f + 0.5f * std::cos(2 * kPi * (t - phase))); };
    return {channel(0), channel(1 / 3.0f), channel(2 / 3.0f)};
}

/// Each pixel becomes a square of size × size pixels. Large squares get a dark border, and a white dot at the center.
inline ImageRgb magnify(const ImageRgb& image, int size) {
    ImageRgb large(image.width() * size, image.height() * size);
    const auto is_middle = [size](int x) { return std::abs(x % size - size / 2) <= 1; };
    for (int y = 0; y < large.height(); ++y)
        for (int x = 0; x < large.width(); ++x) {
            const bool border = size >= 6 && (x % size == 0 || y % size == 0);
            large(x, y) = image(x / size, y / size) * (border ? 0.5f : 1.0f);
            if (size >= 20 && is_middle(x) && is_middle(y)) large(x, y) = Rgb(1);
        }
    return large;
}

/// Lines from each point to the next. The points are in pixels of an image that was enlarged by a factor.
inline void draw_path(ImageRgb& image, const std::vector<Vec2>& points, float factor, Rgb color) {
    const auto place = [factor](float x) { return static_cast<int>(std::floor(x * factor)); };
    for (std::size_t i = 1; i < points.size(); ++i)
        draw_line(image, place(points[i - 1].x), place(points[i - 1].y), place(points[i].x), place(points[i].y), color);
}

/// Images side by side on white, with a white gap of 10 pixels between them.
inline ImageRgb beside(const std::vector<ImageRgb>& images) {
    int width = -10, height = 0;
    for (const ImageRgb& image : images) width += image.width() + 10, height = std::max(height, image.height());
    ImageRgb all(width, height, Rgb(1));
    int left = 0;
    for (const ImageRgb& image : images) {
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) all(left + x, y) = image(x, y);
        left += image.width() + 10;
    }
    return all;
}

} // namespace duet::lesson

// This header declares bilinear interpolation in an image.
#pragma once

#include "common/image/image.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {

/// Interpolates bilinearly between the four pixels about (x, y), in pixels from the upper left corner. Positions
/// beyond an edge are clamped. With `around` the image wraps horizontally, and x must be in [0, width].
inline Rgb bilinear(const ImageRgb& image, float x, float y, bool around = false) {
    const int width = image.width(), height = image.height();
    x -= 0.5f;
    if (!around) x = clamp(x, 0.0f, static_cast<float>(width - 1));
    y = clamp(y - 0.5f, 0.0f, static_cast<float>(height - 1));
    const float left = std::floor(x);
    const int x0 = (static_cast<int>(left) + width) % width,
              x1 = around ? (x0 + 1) % width : std::min(x0 + 1, width - 1);
    const int y0 = static_cast<int>(y), y1 = std::min(y0 + 1, height - 1);
    const float fx = x - left, fy = y - static_cast<float>(y0);
    return lerp(lerp(image(x0, y0), image(x1, y0), fx), lerp(image(x0, y1), image(x1, y1), fx), fy);
}

} // namespace duet::raster

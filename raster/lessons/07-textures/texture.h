// Colors from images.
#pragma once

#include "common/image/image.h"

#include <cmath>

namespace duet::lesson {

/// The texel in column x of row y, both counted from the lower left corner. The image repeats beyond its edges.
template <typename Pixel> Pixel texel(const Image<Pixel>& image, int x, int y) {
    const auto wrapped = [](int i, int size) { return ((i % size) + size) % size; };
    return image(wrapped(x, image.width()), image.height() - 1 - wrapped(y, image.height()));
}

/// The texel that the point uv lies in. (0, 0) is the image's lower left corner, (1, 1) its upper right one.
template <typename Pixel> Pixel nearest(const Image<Pixel>& image, Vec2 uv) {
    return texel(image, static_cast<int>(std::floor(uv.x * static_cast<float>(image.width()))),
                 static_cast<int>(std::floor(uv.y * static_cast<float>(image.height()))));
}

/// The colors of the four texels whose centers are around the point uv, each by how near it is. A texel's center is
/// half a texel from its corner: there the result is the texel's own color.
template <typename Pixel> Pixel bilinear(const Image<Pixel>& image, Vec2 uv) {
    const float x = uv.x * static_cast<float>(image.width()) - 0.5f;
    const float y = uv.y * static_cast<float>(image.height()) - 0.5f;
    const float left = std::floor(x), below = std::floor(y), s = x - left, t = y - below;
    const int i = static_cast<int>(left), j = static_cast<int>(below);
    const Pixel low = texel(image, i, j) * (1 - s) + texel(image, i + 1, j) * s;
    const Pixel high = texel(image, i, j + 1) * (1 - s) + texel(image, i + 1, j + 1) * s;
    return low * (1 - t) + high * t;
}

} // namespace duet::lesson

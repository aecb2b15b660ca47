// The eye at the origin, and the picture it sees.
#pragma once

#include "common/image/image.h"
#include "common/image/srgb.h"
#include "common/vec/ray.h"

namespace duet::lesson {

/// The ray from the eye at the origin through the point (x, y) of a picture, in pixels from its upper left corner. The
/// picture is a window at z = -1 that is `window` high, with x to the right and y up.
inline Ray eye_ray(float x, float y, int width, int height, float window = 2) {
    const float pixel = window / static_cast<float>(height);
    return {{0, 0, 0},
            {(x - 0.5f * static_cast<float>(width)) * pixel, (0.5f * static_cast<float>(height) - y) * pixel, -1}};
}

/// A picture whose pixels are color(ray), each of the ray through its center.
template <typename Color> ImageRgb draw(int width, int height, float window, const Color& color) {
    ImageRgb image(width, height);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const float x = static_cast<float>(column) + 0.5f, y = static_cast<float>(row) + 0.5f;
            image(column, row) = color(eye_ray(x, y, width, height, window));
        }
    return image;
}

/// A unit normal as a color: each component from [-1, 1] to [0, 1], and decoded, since write_image will encode it.
inline Rgb normal_color(Vec3 n) {
    return {srgb_decode(0.5f * (n.x + 1)), srgb_decode(0.5f * (n.y + 1)), srgb_decode(0.5f * (n.z + 1))};
}

} // namespace duet::lesson

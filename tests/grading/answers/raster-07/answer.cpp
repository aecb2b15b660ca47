// Textures, from the page of the lesson.
#include "raster/lessons/07-textures/lab.h"

#include <cmath>

namespace duet::lab {

Vec3 perspective_weights(Vec3 weights, Vec3 w) {
    const Vec3 divided{weights.x / w.x, weights.y / w.y, weights.z / w.z};
    const float sum = divided.x + divided.y + divided.z;
    return divided / sum;
}

int wrap(int i, int size) {
    const int remainder = i % size;
    return remainder < 0 ? remainder + size : remainder;
}

Rgb nearest(const ImageRgb& image, Vec2 uv) {
    const int x = static_cast<int>(std::floor(uv.x * static_cast<float>(image.width())));
    const int y = static_cast<int>(std::floor(uv.y * static_cast<float>(image.height())));
    const int row = image.height() - 1 - wrap(y, image.height());
    return image(wrap(x, image.width()), row);
}

Rgb bilinear(const ImageRgb& image, Vec2 uv) {
    const float half = 0.5f;
    const float x = uv.x * static_cast<float>(image.width()) - half;
    const float y = uv.y * static_cast<float>(image.height()) - half;
    const int left = static_cast<int>(std::floor(x)), below = static_cast<int>(std::floor(y));
    const float s = x - std::floor(x), t = y - std::floor(y);
    const auto at = [&](int i, int j) {
        return image(wrap(i, image.width()), image.height() - 1 - wrap(j, image.height()));
    };
    const int right = left + 1, above = below + 1;
    const Rgb low = at(left, below) * (1 - s) + at(right, below) * s;
    const Rgb high = at(left, above) * (1 - s) + at(right, above) * s;
    return low * (1 - t) + high * t;
}

ImageRgb draw_quad(const std::array<Corner, 4>& corners, const ImageRgb& texture, int width, int height,
                   Rgb background) {
    ImageRgb image(width, height, background);
    const std::array<std::array<std::size_t, 3>, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
    for (const auto& triangle : triangles) {
        const Corner &a = corners[triangle[0]], &b = corners[triangle[1]], &c = corners[triangle[2]];
        const Vec4 pa = lesson::to_image(a.clip, width, height);
        const Vec4 pb = lesson::to_image(b.clip, width, height);
        const Vec4 pc = lesson::to_image(c.clip, width, height);
        lesson::for_each_pixel({pa.x, pa.y}, {pb.x, pb.y}, {pc.x, pc.y}, width, height, [&](int x, int y, Vec3 seen) {
            const Vec3 w = perspective_weights(seen, {pa.w, pb.w, pc.w});
            const Vec2 uv = a.uv * w.x + b.uv * w.y + c.uv * w.z;
            image(x, y) = bilinear(texture, uv);
        });
    }
    return image;
}

} // namespace duet::lab

// A z-buffer: the nearest depth so far beside the color of each pixel.
#include "raster/lessons/02-triangles/triangle.h"
#include "raster/lessons/03-z-buffer/lab.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace duet::lab {

float depth_at(const Triangle& triangle, Vec3 weights) {
    const float a = triangle.corners[0].z * weights.x;
    const float b = triangle.corners[1].z * weights.y;
    const float c = triangle.corners[2].z * weights.z;
    return a + b + c;
}

bool passes(float z, float stored) { return z < stored; }

int quantize(float z, int bits) {
    const float last_level = static_cast<float>((1 << bits) - 1);
    const float clamped = std::clamp(z, 0.0f, 1.0f);
    return static_cast<int>(std::lround(clamped * last_level));
}

/// Draws over what the image and its depths hold. store(z) is the depth that is compared.
template <typename Store>
void draw_into(ImageRgb& image, ImageFloat& depth, const std::vector<Triangle>& triangles, Store store) {
    for (const Triangle& t : triangles) {
        const Vec3 a = t.corners[0], b = t.corners[1], c = t.corners[2];
        lesson::for_each_pixel({a.x, a.y}, {b.x, b.y}, {c.x, c.y}, image.width(), image.height(),
                               [&](int x, int y, Vec3 w) {
                                   const float z = store(depth_at(t, w));
                                   if (!passes(z, depth(x, y))) return;
                                   depth(x, y) = z;
                                   image(x, y) = t.colors[0] * w.x + t.colors[1] * w.y + t.colors[2] * w.z;
                               });
    }
}

constexpr float kFarthest = std::numeric_limits<float>::infinity();

ImageRgb draw(const std::vector<Triangle>& triangles, int width, int height, Rgb background) {
    ImageRgb image(width, height, background);
    ImageFloat depth(width, height, kFarthest);
    draw_into(image, depth, triangles, [](float z) { return z; });
    return image;
}

ImageRgb draw_quantized(const std::vector<Triangle>& triangles, int width, int height, Rgb background, int bits) {
    ImageRgb image(width, height, background);
    ImageFloat depth(width, height, kFarthest);
    draw_into(image, depth, triangles, [bits](float z) { return static_cast<float>(quantize(z, bits)); });
    return image;
}

std::vector<ImageRgb> draw_frames(const std::vector<std::vector<Triangle>>& frames, int width, int height,
                                  Rgb background) {
    std::vector<ImageRgb> images;
    ImageFloat depth(width, height, kFarthest);
    ImageRgb image(width, height, background);
    for (const std::vector<Triangle>& triangles : frames) {
        for (float& z : depth.pixels()) z = kFarthest;
        for (Rgb& color : image.pixels()) color = background;
        draw_into(image, depth, triangles, [](float z) { return z; });
        images.push_back(image);
    }
    return images;
}

} // namespace duet::lab

// Textures, from the page of the lesson.
#include "raytrace/lessons/09-textures/lab.h"

#include <algorithm>
#include <cmath>

namespace duet::lab {

Vec2 sphere_uv(Vec3 n) {
    const float pi = 3.14159265f;
    const float longitude = std::atan2(n.x, n.z);
    const float y = std::max(-1.0f, std::min(1.0f, n.y));
    const float latitude = std::asin(y);
    const float u = 0.5f + longitude / (2 * pi);
    const float v = 0.5f + latitude / pi;
    return {std::max(0.0f, std::min(1.0f, u)), v};
}

Rgb image_color(const ImageRgb& image, Vec2 uv) {
    const int width = image.width(), height = image.height();
    int column = static_cast<int>(std::floor(uv.x * static_cast<float>(width)));
    column = (column % width + width) % width;
    int below = static_cast<int>(std::floor(uv.y * static_cast<float>(height)));
    below = std::max(0, std::min(height - 1, below));
    const int row = height - 1 - below;
    return image(column, row);
}

bool checker(Vec3 p) {
    const int x = static_cast<int>(std::floor(p.x));
    const int y = static_cast<int>(std::floor(p.y));
    const int z = static_cast<int>(std::floor(p.z));
    return (x + y + z) % 2 != 0;
}

float fade(float t) { return 6 * std::pow(t, 5.0f) - 15 * std::pow(t, 4.0f) + 10 * std::pow(t, 3.0f); }

float gradient_noise(Vec3 p) {
    const int x0 = static_cast<int>(std::floor(p.x));
    const int y0 = static_cast<int>(std::floor(p.y));
    const int z0 = static_cast<int>(std::floor(p.z));
    float sum = 0;
    for (int x = x0; x <= x0 + 1; ++x)
        for (int y = y0; y <= y0 + 1; ++y)
            for (int z = z0; z <= z0 + 1; ++z) {
                const Vec3 corner{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
                const Vec3 d = p - corner;
                const float wx = fade(1 - std::abs(d.x));
                const float wy = fade(1 - std::abs(d.y));
                const float wz = fade(1 - std::abs(d.z));
                const Vec3 slope = gradient(x, y, z);
                sum += wx * wy * wz * dot(slope, d);
            }
    return sum;
}

float turbulence(Vec3 p, int octaves) {
    float sum = 0, strength = 1;
    for (int i = 0; i < octaves; ++i) {
        sum += strength * std::abs(gradient_noise(p));
        p = p * 2.0f;
        strength = strength / 2;
    }
    return sum; // of all octaves
}

} // namespace duet::lab

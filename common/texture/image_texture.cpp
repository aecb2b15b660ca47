#include "common/texture/texture_kinds.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

// The place of a coordinate within its period, in [0, 1); 0 for what has none (infinity, NaN). In double the product
// and the difference are exact but for the tiniest negative coordinates, which would round to 1.
double wrapped(float coordinate, float scale) {
    const double t = static_cast<double>(coordinate) * static_cast<double>(scale);
    const double place = t - std::floor(t);
    return place < 1 ? place : 0.0;
}

// The two texels whose centres enclose a place, and the second one's weight: 0 exactly at the first one's centre.
struct Neighbours {
    int first, second;
    float weight;
};
Neighbours neighbours(double place, int count) {
    const double x = place * count - 0.5, first = std::floor(x);
    const int i = static_cast<int>(first); // in [−1, count − 1]
    return {i < 0 ? count - 1 : i, i + 1 < count ? i + 1 : 0, static_cast<float>(x - first)};
}

int nearest(double place, int count) { return std::min(static_cast<int>(place * count), count - 1); }

} // namespace

Rgb evaluate(const ImageTexture& texture, const ImageRgb& image, Vec2 uv) {
    const int width = image.width(), height = image.height();
    const double s = wrapped(uv.x, texture.scale.x), t = wrapped(uv.y, texture.scale.y);
    // Rows are stored from the top, v rises from the bottom.
    const auto texel = [&](int x, int y) { return image(x, height - 1 - y); };
    if (!texture.bilinear) return texel(nearest(s, width), nearest(t, height));
    const Neighbours x = neighbours(s, width), y = neighbours(t, height);
    return lerp(lerp(texel(x.first, y.first), texel(x.second, y.first), x.weight),
                lerp(texel(x.first, y.second), texel(x.second, y.second), x.weight), y.weight);
}

} // namespace duet

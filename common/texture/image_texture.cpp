#include "common/texture/probe_line.h"
#include "common/texture/texture_kinds.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

// The place of a coordinate within its period, in [0, 1); 0 for what has none (infinity, NaN). The difference is exact
// but for the tiniest negative coordinates, which would round to 1.
double fraction(double t) {
    const double place = t - std::floor(t);
    return place < 1 ? place : 0.0;
}
// In double the product is exact, too.
double wrapped(float coordinate, float scale) {
    return fraction(static_cast<double>(coordinate) * static_cast<double>(scale));
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

Rgb bilinear(const ImageRgb& image, double s, double t) {
    const int height = image.height();
    const Neighbours x = neighbours(s, image.width()), y = neighbours(t, height);
    // Rows are stored from the top, v rises from the bottom.
    const auto texel = [&](int i, int j) { return image(i, height - 1 - j); };
    return lerp(lerp(texel(x.first, y.first), texel(x.second, y.first), x.weight),
                lerp(texel(x.first, y.second), texel(x.second, y.second), x.weight), y.weight);
}

} // namespace

Rgb evaluate(const ImageTexture& texture, const ImageRgb& image, const std::vector<ImageRgb>& smaller,
             const SurfacePoint& point) {
    const double s = wrapped(point.uv.x, texture.scale.x), t = wrapped(point.uv.y, texture.scale.y);
    if (texture.filter == TextureFilter::kNearest)
        return image(nearest(s, image.width()), image.height() - 1 - nearest(t, image.height()));
    if (!uses_footprint(texture.filter) || smaller.empty()) return bilinear(image, s, t);

    const Vec2d scale(texture.scale);
    const auto in_texels = [&](Vec2 duv) {
        return Vec2d(duv.x * scale.x * image.width(), duv.y * scale.y * image.height());
    };
    const ProbeLine probes = probe_line(in_texels(point.duv_dx), in_texels(point.duv_dy),
                                        texture.filter == TextureFilter::kAnisotropic ? kMaxProbes : 1);
    const auto level = [&](int k) -> const ImageRgb& {
        return k == 0 ? image : smaller[static_cast<std::size_t>(std::min(k, static_cast<int>(smaller.size()))) - 1];
    };
    const ImageRgb &fine = level(probes.level), &coarse = level(probes.level + 1);
    Rgb sum;
    for (int i = 0; i < probes.count; ++i) {
        const double along = i - 0.5 * (probes.count - 1);
        const double ps = fraction(s + along * probes.step.x / image.width());
        const double pt = fraction(t + along * probes.step.y / image.height());
        const Rgb sharp = bilinear(fine, ps, pt);
        sum += probes.blend == 0 ? sharp : lerp(sharp, bilinear(coarse, ps, pt), probes.blend);
    }
    return sum * (1 / static_cast<float>(probes.count));
}

} // namespace duet

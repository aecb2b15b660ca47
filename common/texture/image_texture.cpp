#include "common/texture/probe_line.h"
#include "common/texture/texel_place.h"
#include "common/texture/texture_kinds.h"

#include <algorithm>

namespace duet {

namespace {

// In double the product is exact, too.
double wrapped(float coordinate, float scale) {
    return fraction(static_cast<double>(coordinate) * static_cast<double>(scale));
}

int nearest(double place, int count) { return std::min(static_cast<int>(place * count), count - 1); }

Rgb bilinear(const ImageRgb& image, double s, double t) {
    const TexelPair<double> x(s, image.width()), y(t, image.height());
    // Rows are stored from the top, v rises from the bottom.
    const auto texel = [&](double i, double j) { return image(static_cast<int>(i), image.height() - 1 - static_cast<int>(j)); };
    return bilinear(texel(x.first, y.first), texel(x.second, y.first), texel(x.first, y.second), texel(x.second, y.second),
                    static_cast<float>(x.weight), static_cast<float>(y.weight));
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
    const ProbeLine probes = probe_line(in_texels(point.duv_dx), in_texels(point.duv_dy), max_probes(texture.filter));
    const auto level = [&](int k) -> const ImageRgb& {
        return k == 0 ? image : smaller[static_cast<std::size_t>(std::min(k, static_cast<int>(smaller.size()))) - 1];
    };
    const ImageRgb &fine = level(static_cast<int>(probes.level)), &coarse = level(static_cast<int>(probes.level) + 1);
    const auto blend = static_cast<float>(probes.blend);
    Rgb sum;
    for (int i = 0; i < probes.count; ++i) {
        const double along = i - 0.5 * (probes.count - 1);
        const double ps = fraction(s + along * probes.step.x / image.width());
        const double pt = fraction(t + along * probes.step.y / image.height());
        const Rgb sharp = bilinear(fine, ps, pt);
        sum += blend == 0 ? sharp : lerp(sharp, bilinear(coarse, ps, pt), blend);
    }
    return sum * (1 / static_cast<float>(probes.count));
}

} // namespace duet

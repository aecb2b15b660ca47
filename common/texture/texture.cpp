#include "common/texture/texture.h"

#include "common/texture/noise.h"

#include <cmath>

namespace duet {

namespace {

// x modulo 1, in [0, 1), for any finite x.
double fractional(double x) {
    const double f = x - std::floor(x);
    return f < 1 ? f : 0;
}

// Bilinear between the four texels around, or the nearest; repeats, and v = 0 is the bottom.
Rgb evaluate(const TextureSet& set, const ImageTexture& texture, const SurfacePoint& point) {
    const ImageRgb& image = set.images[texture.image];
    const int width = image.width(), height = image.height();
    const double u = fractional(static_cast<double>(point.uv.x) * static_cast<double>(texture.scale.x));
    const double v = fractional(static_cast<double>(point.uv.y) * static_cast<double>(texture.scale.y));
    const double x = u * width, y = (1 - v) * height;
    const auto wrapped = [](int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; };
    if (!texture.bilinear) return image(wrapped(static_cast<int>(x), width), wrapped(static_cast<int>(y), height));
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const int x0 = wrapped(static_cast<int>(left), width), x1 = wrapped(x0 + 1, width);
    const int y0 = wrapped(static_cast<int>(top), height), y1 = wrapped(y0 + 1, height);
    const auto s = static_cast<float>(x - 0.5 - left), t = static_cast<float>(y - 0.5 - top);
    return lerp(lerp(image(x0, y0), image(x1, y0), s), lerp(image(x0, y1), image(x1, y1), s), t);
}

bool is_odd(double x) { return fractional(std::floor(x) / 2) != 0; }

Rgb evaluate(const CheckerTexture& texture, const SurfacePoint& point) {
    const double scale = static_cast<double>(texture.scale);
    bool odd = false;
    if (texture.solid) {
        const Vec3d p = Vec3d(point.p_object) * scale;
        odd = is_odd(p.x) != (is_odd(p.y) != is_odd(p.z));
    } else {
        odd = is_odd(static_cast<double>(point.uv.x) * scale) != is_odd(static_cast<double>(point.uv.y) * scale);
    }
    return odd ? texture.odd : texture.even;
}

Rgb evaluate(const NoiseTexture& texture, const SurfacePoint& point) {
    const Vec3d p = Vec3d(point.p_object) * static_cast<double>(texture.scale);
    const double value =
        texture.marble ? std::sin(p.z + 10 * turbulence(p, texture.octaves)) : fractal_noise(p, texture.octaves);
    return lerp(texture.low, texture.high, static_cast<float>(clamp(0.5 + 0.5 * value, 0.0, 1.0)));
}

} // namespace

Rgb evaluate_texture(const TextureSet& set, const Texture& texture, const SurfacePoint& point) {
    if (const auto* image = std::get_if<ImageTexture>(&texture)) return evaluate(set, *image, point);
    if (const auto* checker = std::get_if<CheckerTexture>(&texture)) return evaluate(*checker, point);
    return evaluate(std::get<NoiseTexture>(texture), point);
}

} // namespace duet

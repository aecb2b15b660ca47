#include "common/texture/anisotropic_probes.h"
#include "common/texture/texture.h"
#include "common/texture/texel_index.h"

#include <algorithm>

namespace duet {

namespace {

int nearest_texel(float s, int count) { return std::min(static_cast<int>(s * static_cast<float>(count)), count - 1); }

Vec2 size_of(const ImageRgb& image) { return {static_cast<float>(image.width()), static_cast<float>(image.height())}; }

Rgb bilinear(const ImageRgb& image, float s, float t) {
    const Vec2 size = size_of(image);
    const TexelPair<float> x(s, size.x), y(t, size.y);
    // Rows are stored from the top, but v increases from the bottom.
    const auto texel = [&](float i, float j) {
        return image(static_cast<int>(i), image.height() - 1 - static_cast<int>(j));
    };
    return bilinear(texel(x.first, y.first), texel(x.second, y.first), texel(x.first, y.second),
                    texel(x.second, y.second), x.weight, y.weight);
}

} // namespace

Rgb evaluate(const ImageTexture& texture, const ImageRgb& image, const std::vector<ImageRgb>& mip_levels,
             const SurfacePoint& point) {
    // Floats suffice: the coordinates are floats too, and their rounding error already is an error of position.
    const float s = wrap_repeat(point.uv.x * texture.scale.x), t = wrap_repeat(point.uv.y * texture.scale.y);
    if (texture.filter == TextureFilter::kNearest)
        return image(nearest_texel(s, image.width()), image.height() - 1 - nearest_texel(t, image.height()));
    if (!uses_footprint(texture.filter) || mip_levels.empty()) return bilinear(image, s, t);

    const Vec2 size = size_of(image), scale{texture.scale.x * size.x, texture.scale.y * size.y};
    const auto in_texels = [&](Vec2 duv) { return Vec2(duv.x * scale.x, duv.y * scale.y); };
    const AnisotropicProbes probes =
        anisotropic_probes(in_texels(point.duv_dx), in_texels(point.duv_dy), max_anisotropy(texture.filter));
    const Vec2 step{probes.step.x * (1 / size.x), probes.step.y * (1 / size.y)};
    const auto level = [&](int k) -> const ImageRgb& {
        return k == 0 ? image
                      : mip_levels[static_cast<std::size_t>(std::min(k, static_cast<int>(mip_levels.size()))) - 1];
    };
    const ImageRgb &fine = level(static_cast<int>(probes.level)), &coarse = level(static_cast<int>(probes.level) + 1);
    Rgb sum;
    for (float i = 0; i < probes.count; ++i) {
        const float along = i - 0.5f * (probes.count - 1);
        const float ps = wrap_repeat(s + along * step.x), pt = wrap_repeat(t + along * step.y);
        const Rgb fine_color = bilinear(fine, ps, pt);
        sum += probes.blend == 0 ? fine_color : lerp_fused(fine_color, bilinear(coarse, ps, pt), probes.blend);
    }
    return sum * (1 / probes.count);
}

} // namespace duet

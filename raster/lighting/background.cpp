#include "raster/lighting/background.h"

#include "raster/geometry/lane_math.h"

#include <cmath>
#include <variant>

namespace duet::raster {

bool shows_environment(const RasterSceneData& data, const RasterSettings& settings) {
    return settings.environment && (data.scene.needs.environment || !settings.skips.environment);
}

bool is_dark(const RasterSceneData& data, const RasterSettings& settings) {
    return data.scene.lights.empty() && !shows_environment(data, settings) && !data.any_emits;
}

namespace {

/// Looks up the image like radiance() of common/light/environment.h, but for one direction per lane, in float.
RgbT<Floats> radiance(const ImageEnvironment& e, const Vec3T<Floats>& w) {
    const Floats half(0.5f), one(1.0f), zero(0.0f);
    if (e.image.empty()) return {zero, zero, zero};
    const Floats width(static_cast<float>(e.image.width())), rows(static_cast<float>(e.image.height()));
    const double rotation = static_cast<double>(e.rotation) / (2 * kPiDouble);
    const Floats offset(static_cast<float>(0.5 + rotation - std::floor(rotation)));
    const auto pole = (w.x == zero) & (w.z == zero); // xsimd's atan2(0, 0) is not a number
    const Floats turn = xsimd::atan2(w.x, xsimd::select(pole, one, -w.z)) * Floats(kInvPi / 2) + offset;
    const Floats latitude = xsimd::atan2(w.y, xsimd::sqrt(w.x * w.x + w.z * w.z)) * Floats(kInvPi);
    const Floats x = (turn - xsimd::floor(turn)) * width - half, y = (half - latitude) * rows - half;
    const Floats left = xsimd::floor(x), top = xsimd::floor(y);
    // The lookup wraps around in longitude and is clamped in latitude. The column is clamped in case of rounding.
    const Floats column = xsimd::select(left < zero, width - one, min(left, width - one)),
                 next = xsimd::select(left + one < width, left + one, zero);
    const Floats row = clamp(top, zero, rows - one), below = clamp(top + one, zero, rows - one);
    const auto texel = [&](const Floats& i, const Floats& j) {
        const Ints at = (truncated(j) * Ints(e.image.width()) + truncated(i)) * Ints(3);
        const float* colors = &e.image.pixels().data()->r;
        return RgbT<Floats>{gather(colors, at), gather(colors + 1, at), gather(colors + 2, at)};
    };
    const auto in_row = [&](const Floats& j) { return lerp(texel(column, j), texel(next, j), Floats(x - left)); };
    return lerp(in_row(row), in_row(below), Floats(y - top)) * Floats(e.scale);
}

} // namespace

void draw_background(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer, bool sun,
                     Planes3& image) {
    if (settings.shading != Shading::kLit || !settings.components.emission || !shows_environment(data, settings))
        return;
    const ScreenProjection& projection = gbuffer.projection;
    const auto directions = [&](int x, int y) {
        if (!gbuffer.position.empty()) return unit_of(gbuffer.position.vector(x, y)); // padding lanes hold zero
        return -projection.to_viewer(projection.point(Floats(static_cast<float>(x)) + load(kLanesAsFloats, 0),
                                                      Floats(static_cast<float>(y)), Floats(projection.near())));
    };
    std::visit([&](const auto& environment) {
        for_each_batch(gbuffer.width(), gbuffer.height(), settings.threads, [&](int x, int y) {
            const xsimd::batch_bool<float> visible = gbuffer.visible(x, y);
            if (xsimd::all(visible)) return;
            const Vec3T<Floats> w = directions(x, y);
            RgbT<Floats> arriving = radiance(environment, w);
            if (data.sun && !sun) arriving = data.sun->without_sun(w, arriving);
            image.set(x, y, blend(visible, image.color(x, y), arriving));
        });
    }, data.scene.environment);
}

} // namespace duet::raster

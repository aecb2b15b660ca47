#include "raster/lighting/shadow_denoiser.h"

#include "raster/gbuffer/neighbors.h"

#include <algorithm>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

constexpr int kWidth = static_cast<int>(Floats::size);

/// Classifies the shadows of a batch. A batch that is lit or dark all over needs no averaging.
enum class Shade : std::uint8_t { kLit, kDark, kMixed };

Shade shade_of(const RgbT<Floats>& lit) {
    const Floats zero(0.0f), one(1.0f);
    const Mask none = lit.r < zero; // lanes that no light could reach
    if (xsimd::all(none | ((lit.r == one) & (lit.g == one) & (lit.b == one)))) return Shade::kLit;
    return xsimd::all(none | (max_component(lit) == zero)) ? Shade::kDark : Shade::kMixed;
}

/// Returns the mean of the lit fractions of the block around each pixel, weighted by the likeness of the surfaces.
RgbT<Floats> mean_of_block(const GBuffer& gbuffer, const Planes3& lit, int x, int y) {
    const ScreenProjection& projection = gbuffer.projection;
    const Vec3s p = gbuffer.points(x, y), n = gbuffer.normal.vector(x, y);
    const Floats least(1e-30f), zero(0.0f);
    const Floats tolerance = plane_tolerance(projection, load(gbuffer.reversed_depth, x, y));
    RgbT<Floats> sum(zero);
    Floats weights(zero);
    for (int dy = -kDitherSide / 2; dy < kDitherSide / 2; ++dy)
        for (int dx = -kDitherSide / 2; dx < kDitherSide / 2; ++dx) {
            const Floats other = load_at(gbuffer.reversed_depth, x + dx, y + dy);
            const Vec3s q = projection.point(Floats(static_cast<float>(x + dx)) + load(kLanesAsFloats, 0),
                                             Floats(static_cast<float>(y + dy)), max(other, least));
            const Floats alike = likeness(p, n, tolerance, q, load_at(gbuffer.normal, x + dx, y + dy));
            const Vec3s part = load_at(lit, x + dx, y + dy);
            const Floats weight = xsimd::select((other > zero) & (part.x >= zero), alike, zero);
            sum += RgbT<Floats>{part.x, part.y, part.z} * weight;
            weights += weight;
        }
    return sum * (Floats(1.0f) / max(weights, least));
}

} // namespace

void add_direct_light(const GBuffer& gbuffer, const DirectLight& light, int threads, Planes3& radiance) {
    const int width = gbuffer.width(), height = gbuffer.height(), batches = (width + kWidth - 1) / kWidth;
    if (light.lit.empty()) {
        for_each_batch(width, height, threads, [&](int x, int y) {
            radiance.set(x, y, radiance.color(x, y) + light.exact.color(x, y));
        });
        return;
    }
    Image<Shade> shades(batches, height);
    for_each_batch(width, height, threads,
                   [&](int x, int y) { shades(x / kWidth, y) = shade_of(light.lit.color(x, y)); });
    const auto needs_filter = [&](int x, int y) {
        const Shade own = shades(x / kWidth, y);
        if (own == Shade::kMixed) return true;
        for (int row = std::max(y - kDitherSide / 2, 0); row < std::min(y + kDitherSide / 2, height); ++row)
            for (int b = std::max(x / kWidth - 1, 0); b <= std::min(x / kWidth + 1, batches - 1); ++b)
                if (shades(b, row) != own) return true;
        return false;
    };
    for_each_batch(width, height, threads, [&](int x, int y) {
        const RgbT<Floats> lit = needs_filter(x, y) ? mean_of_block(gbuffer, light.lit, x, y) : light.lit.color(x, y);
        radiance.set(x, y, radiance.color(x, y) + light.exact.color(x, y) + light.unshadowed.color(x, y) * lit);
    });
}

} // namespace duet::raster

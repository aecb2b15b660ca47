#include "raster/lighting/shadow_filter.h"

#include "raster/gbuffer/neighbors.h"

#include <algorithm>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

constexpr int kBlock = 4; ///< pixels along a side whose taps differ
constexpr int kWidth = static_cast<int>(Floats::size);

/// Where a batch's shadows have nothing to average: no light is blocked, or all of it.
enum class Shade : std::uint8_t { kLit, kDark, kMixed };

Shade shade_of(const RgbT<Floats>& unshadowed, const RgbT<Floats>& shadowed) {
    const auto equal = (unshadowed.r == shadowed.r) & (unshadowed.g == shadowed.g) & (unshadowed.b == shadowed.b);
    if (xsimd::all(equal)) return Shade::kLit;
    return xsimd::all(shadowed.r + shadowed.g + shadowed.b == Floats(0.0f)) ? Shade::kDark : Shade::kMixed;
}

/// Sums the light of a block, weighted by how alike its surfaces are.
struct BlockSums {
    RgbT<Floats> unshadowed{Floats(0.0f)}, shadowed{Floats(0.0f)};

    BlockSums(const GBuffer& gbuffer, const DirectLight& light, int x, int y) {
        const ScreenProjection& projection = gbuffer.projection;
        const Vec3s p = gbuffer.points(x, y), n = gbuffer.normal.vector(x, y);
        const Floats depth = max(load(gbuffer.reversed_depth, x, y), Floats(1e-30f));
        const Floats tolerance = Floats(kPlaneTolerance) * projection.pixel_size(Floats(projection.near()) / depth);
        for (int dy = -kBlock / 2; dy < kBlock / 2; ++dy)
            for (int dx = -kBlock / 2; dx < kBlock / 2; ++dx) {
                const Floats other = load_at(gbuffer.reversed_depth, x + dx, y + dy);
                const Vec3s q = projection.point(Floats(static_cast<float>(x + dx)) + load(kLanesAsFloats, 0),
                                                 Floats(static_cast<float>(y + dy)), max(other, Floats(1e-30f)));
                const Floats alike = likeness(p, n, tolerance, q, load_at(gbuffer.normal, x + dx, y + dy));
                const Floats weight = xsimd::select(other > Floats(0.0f), alike, Floats(0.0f));
                const Vec3s all = load_at(light.unshadowed, x + dx, y + dy),
                            some = load_at(light.shadowed, x + dx, y + dy);
                unshadowed += RgbT<Floats>{all.x, all.y, all.z} * weight;
                shadowed += RgbT<Floats>{some.x, some.y, some.z} * weight;
            }
    }
};

} // namespace

void add_direct_light(const GBuffer& gbuffer, const DirectLight& light, int threads, Planes3& radiance) {
    const int width = gbuffer.width(), height = gbuffer.height(), batches = (width + kWidth - 1) / kWidth;
    if (light.shadowed.empty()) {
        for_each_batch(width, height, threads, [&](int x, int y) {
            radiance.set(x, y, radiance.color(x, y) + light.exact.color(x, y));
        });
        return;
    }
    Image<Shade> shades(batches, height);
    for_each_batch(width, height, threads, [&](int x, int y) {
        shades(x / kWidth, y) = shade_of(light.unshadowed.color(x, y), light.shadowed.color(x, y));
    });
    const auto needs_filter = [&](int x, int y) {
        const Shade own = shades(x / kWidth, y);
        if (own == Shade::kMixed) return true;
        for (int row = std::max(y - kBlock / 2, 0); row < std::min(y + kBlock / 2, height); ++row)
            for (int b = std::max(x / kWidth - 1, 0); b <= std::min(x / kWidth + 1, batches - 1); ++b)
                if (shades(b, row) != own) return true;
        return false;
    };
    for_each_batch(width, height, threads, [&](int x, int y) {
        RgbT<Floats> arriving = light.shadowed.color(x, y);
        if (needs_filter(x, y)) {
            const RgbT<Floats> exact = light.unshadowed.color(x, y);
            const BlockSums sums(gbuffer, light, x, y);
            const auto channel = [](const Floats& all, const Floats& lit, const Floats& own) {
                return xsimd::select(all > Floats(0.0f), own * (lit / max(all, Floats(1e-30f))), Floats(0.0f));
            };
            arriving = {channel(sums.unshadowed.r, sums.shadowed.r, exact.r),
                        channel(sums.unshadowed.g, sums.shadowed.g, exact.g),
                        channel(sums.unshadowed.b, sums.shadowed.b, exact.b)};
        }
        radiance.set(x, y, radiance.color(x, y) + light.exact.color(x, y) + arriving);
    });
}

} // namespace duet::raster

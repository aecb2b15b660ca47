#include "raster/probes/reflections.h"

#include "raster/probes/radiance_lookup.h"
#include "raster/lighting/specular_lobe.h"

#include <algorithm>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;
using Rgbs = RgbT<Floats>;

} // namespace

void add_reflections(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                     const ReflectionProbes* probes, Planes3& radiance) {
    constexpr int kBandRows = 8;
    parallel_for(static_cast<std::size_t>((gbuffer.height() + kBandRows - 1) / kBandRows), settings.threads,
                 [&](std::size_t band) {
        LobeLookup lobe, coat_lobe;
        const int first = static_cast<int>(band) * kBandRows;
        for (int y = first; y < std::min(first + kBandRows, gbuffer.height()); ++y)
            for (int x = 0; x < gbuffer.width(); x += static_cast<int>(Floats::size)) {
                const Mask seen = gbuffer.visible(x, y);
                const Floats zero(0.0f), one(1.0f);
                const Rgbs f0 = gbuffer.specular.color(x, y);
                const Mask lanes = seen & (f0.r + f0.g + f0.b > zero);
                const Floats coat = gbuffer.coat.empty() ? zero : load(gbuffer.coat, x, y);
                const Mask coated = seen & (coat > zero);
                if (!xsimd::any(lanes | coated)) continue;
                const Vec3s p = gbuffer.points(x, y), n = gbuffer.normal.vector(x, y),
                            wo = gbuffer.projection.to_viewer(p);
                const Floats cosine = viewer_cosine(n, wo);
                const Vec3s mirrored = n * (Floats(2.0f) * cosine) - wo;
                const RadianceLookup lookup(data, gbuffer, probes, x, y);
                const Floats alpha = load(gbuffer.alpha, x, y);
                Rgbs sum(zero);
                if (xsimd::any(lanes))
                    sum = lookup(p, n, mirrored, alpha, lanes) *
                          specular_albedo(lobe(alpha, cosine, lanes), f0, alpha, cosine);
                sum = blend(lanes, sum, Rgbs(zero));
                if (xsimd::any(coated)) {
                    const Floats width = load(gbuffer.coat_alpha, x, y);
                    const Floats reflected =
                        coat * specular_albedo(coat_lobe(width, cosine, coated), Rgbs(Floats(0.04f)), width, cosine).r;
                    const Rgbs above = lookup(p, n, mirrored, width, coated) * reflected;
                    sum = blend(coated, sum * (one - reflected) + above, sum);
                }
                radiance.set(x, y, radiance.color(x, y) + sum);
            }
    });
}

} // namespace duet::raster

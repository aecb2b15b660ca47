#include "raster/lighting/indirect_light.h"

namespace duet::raster {
namespace {

/// Returns how much light reaches a surface of this albedo through occluders as bright as itself (Jimenez et al. 2016,
/// "Practical Realtime Strategies for Accurate Indirect Occlusion", §5).
Floats with_bounces(const Floats& visible, const Floats& albedo) {
    const Floats a = Floats(2.0404f) * albedo - Floats(0.3324f), b = Floats(-4.7951f) * albedo + Floats(0.6417f),
                 c = Floats(2.7552f) * albedo + Floats(0.6903f);
    return max(visible, ((visible * a + b) * visible + c) * visible);
}

} // namespace

void add_indirect_light(const Settings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        const GtaoImage* occlusion, Planes3& radiance) {
    for_each_batch(gbuffer.width(), gbuffer.height(), settings.threads, [&](int x, int y) {
        const RgbT<Floats> albedo = gbuffer.diffuse.color(x, y);
        const auto lit = gbuffer.visible(x, y) & (albedo.r + albedo.g + albedo.b > Floats(0.0f));
        if (!xsimd::any(lit)) return;
        RgbT<Floats> light = albedo * probes.irradiance(gbuffer.projection.eye(), gbuffer.points(x, y),
                                                        gbuffer.normal.vector(x, y), lit);
        if (occlusion != nullptr) {
            const Floats visible = occlusion->at(x, y).visible;
            light.r *= with_bounces(visible, albedo.r);
            light.g *= with_bounces(visible, albedo.g);
            light.b *= with_bounces(visible, albedo.b);
        }
        radiance.set(x, y, radiance.color(x, y) + light * xsimd::select(lit, Floats(kInvPi), Floats(0.0f)));
    });
}

} // namespace duet::raster

#include "raster/probes/indirect_light.h"

#include "raster/geometry/lane_math.h"

namespace duet::raster {
namespace {

/// Adds albedo/π times the result of irradiance(x, y, lanes) for each batch.
template <typename Irradiance>
void add_reflected(const RasterSettings& settings, const GBuffer& gbuffer, Planes3& radiance,
                   const Irradiance& irradiance) {
    for_each_batch(gbuffer.width(), gbuffer.height(), settings.threads, [&](int x, int y) {
        const RgbT<Floats> albedo = gbuffer.diffuse.color(x, y);
        const auto lit = gbuffer.visible(x, y) & (albedo.r + albedo.g + albedo.b > Floats(0.0f));
        if (!xsimd::any(lit)) return;
        const RgbT<Floats> light = albedo * irradiance(x, y, lit) * Floats(kInvPi),
                           before = radiance.color(x, y);
        radiance.set(x, y, blend(lit, before + light, before)); // other lanes may hold any number
    });
}

} // namespace

AmbientLight ambient_light(const RasterSceneData& data, const RasterSettings& settings,
                           const ScreenProjection& projection) {
    if (!settings.components.environment) return {};
    const AmbientLight sky = environment_in_fog(data, settings, projection);
    if (!data.irradiance_probes || !settings.indirect_light) return sky;
    return [&probes = *data.irradiance_probes, eye = projection.eye(), sky](const Vec3T<Floats>& p) {
        return probes.mean_radiance(eye, p, sky);
    };
}

void add_indirect_light(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        Planes3& radiance) {
    add_reflected(settings, gbuffer, radiance, [&](int x, int y, const auto& lit) {
        return probes.irradiance(gbuffer.projection, gbuffer.points(x, y), gbuffer.normal.vector(x, y), lit);
    });
}

void add_indirect_light(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        const GtaoImage& half, Planes3& radiance) {
    add_reflected(settings, gbuffer, radiance, [&](int x, int y, const auto& lit) -> RgbT<Floats> {
        const auto [visible, irradiance, from_occluders, found] = half.lit_at(x, y);
        const RgbT<Floats> half_resolution = irradiance * visible + from_occluders;
        const auto alone = lit & !found; // surfaces that no pixel of half resolution shows
        if (!xsimd::any(alone)) return half_resolution;
        const Vec3T<Floats> p = gbuffer.points(x, y), n = gbuffer.normal.vector(x, y);
        return blend(alone, probes.irradiance(gbuffer.projection, p, n, alone), half_resolution);
    });
}

} // namespace duet::raster

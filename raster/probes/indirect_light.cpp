#include "raster/probes/indirect_light.h"

#include "raster/geometry/lane_math.h"

namespace duet::raster {

AmbientLight ambient_light(const RasterSceneData& data, const RasterSettings& settings,
                           const ScreenProjection& projection) {
    if (!settings.components.environment) return {};
    const AmbientLight sky = environment_in_fog(data, settings, projection);
    if (!data.irradiance_probes || !settings.indirect_light) return sky;
    return [&probes = *data.irradiance_probes, eye = projection.eye(), sky](const Vec3T<Floats>& p) {
        return probes.mean_radiance(eye, p, sky);
    };
}

namespace {

/// Returns the irradiance at points of a G-buffer with unit normals n.
RgbT<Floats> irradiance(const GBuffer& gbuffer, const IrradianceProbes& probes, const Vec3T<Floats>& p,
                        const Vec3T<Floats>& n, const xsimd::batch_bool<float>& lanes) {
    const ScreenProjection& camera = gbuffer.projection;
    return gbuffer.eye_enclosed ? probes.irradiance(camera.eye(), p, n, Vec3T<Floats>(Vec3()), lanes)
                                : probes.irradiance(camera, p, n, lanes);
}

} // namespace

void interpolate_probes(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        GtaoImage& half) {
    half.start(gbuffer, settings.threads);
    half.set_irradiance(settings.threads, [&](const auto& p, const auto& n, const auto& lanes) {
        return irradiance(gbuffer, probes, p, n, lanes);
    });
}

float occluder_reach(const RasterSettings& settings, const IrradianceProbes& probes) {
    constexpr float kReach = 0.5f; // of the distance between probes, which see farther occluders themselves
    return settings.ambient_occlusion ? kReach * probes.spacing() : 0;
}

void add_indirect_light(const RasterSettings& settings, const GBuffer& gbuffer, const IrradianceProbes& probes,
                        const GtaoImage& half, Planes3& radiance) {
    for_each_batch(gbuffer.width(), gbuffer.height(), settings.threads, [&](int x, int y) {
        const RgbT<Floats> albedo = gbuffer.diffuse.color(x, y);
        const auto lit = gbuffer.visible(x, y) & (albedo.r + albedo.g + albedo.b > Floats(0.0f));
        if (!xsimd::any(lit)) return;
        const auto [visible, from_all, from_occluders, found] = half.lit_at(x, y);
        RgbT<Floats> arriving = from_all * visible + from_occluders;
        if (const auto alone = lit & !found; xsimd::any(alone)) { // surfaces that no pixel of half resolution shows
            const RgbT<Floats> light =
                irradiance(gbuffer, probes, gbuffer.points(x, y), gbuffer.normal.vector(x, y), alone);
            arriving = blend(alone, light, arriving);
        }
        const RgbT<Floats> before = radiance.color(x, y), after = before + albedo * arriving * Floats(kInvPi);
        radiance.set(x, y, blend(lit, after, before)); // other lanes may hold any number
    });
}

} // namespace duet::raster

#include "raster/lighting/sky_light.h"

#include "raster/geometry/lane_math.h"
#include "raster/lighting/frame_lights.h"
#include "raster/lighting/spherical_harmonics.h"
#include "raster/visibility/shader.h"

#include <array>

namespace duet::raster {

void add_sky_light(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                   const GtaoImage* occlusion, Planes3& radiance) {
    const IrradianceHarmonics& coefficients = data.sky_irradiance;
    const std::vector<Medium> media = frame_media(data.scene.media, settings, gbuffer.projection);
    for_each_batch(gbuffer.width(), gbuffer.height(), settings.threads, [&](int x, int y) {
        const RgbT<Floats> albedo = gbuffer.diffuse.color(x, y);
        const auto lit = gbuffer.visible(x, y) & (albedo.r + albedo.g + albedo.b > Floats(0.0f));
        if (!xsimd::any(lit)) return;
        const SkyVisibility<Floats> sky = occlusion != nullptr ? occlusion->at(x, y) : SkyVisibility<Floats>{};
        const std::array<Floats, 9> toward = harmonics(gbuffer.normal.vector(x, y)), blocked = harmonics(sky.hidden);
        RgbT<Floats> sum = broadcast<Floats>(coefficients[0]) * sky.visible;
        // The coefficients of order 1 include the factor 2/3 of the cosine lobe, but those of a hidden direction must
        // not.
        for (std::size_t i = 1; i < 4; ++i)
            sum += broadcast<Floats>(coefficients[i]) * (toward[i] - Floats(1.5f) * blocked[i]);
        for (std::size_t i = 4; i < 9; ++i) sum += broadcast<Floats>(coefficients[i]) * (toward[i] * sky.visible);
        const Floats none(0.0f);
        RgbT<Floats> irradiance{max(sum.r, none), max(sum.g, none), max(sum.b, none)};
        if (!media.empty()) // the transmittance along the normal approximates all directions
            irradiance *= transmittance(optical_depth<Floats>(media, gbuffer.points(x, y), gbuffer.normal.vector(x, y),
                                                              Floats(kInfinity)));
        const RgbT<Floats> before = radiance.color(x, y);
        radiance.set(x, y, blend(lit, before + albedo * irradiance * Floats(kInvPi), before));
    });
}

} // namespace duet::raster

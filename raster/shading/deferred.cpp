#include "raster/shading/deferred.h"

#include "raster/gbuffer/gbuffer_pass.h"
#include "raster/lighting/background.h"
#include "raster/lighting/direct_light.h"
#include "raster/lighting/environment_light.h"
#include "raster/lighting/indirect_light.h"
#include "raster/lighting/reflections.h"
#include "raster/lighting/refraction.h"
#include "raster/lighting/sky_light.h"
#include "raster/screen_space/required_passes.h"
#include "raster/shadows/map_shadows.h"
#include "raster/shadows/shadow_filter.h"

#include "common/system/stopwatch.h"

namespace duet::raster {
namespace {

/// Occlusion by what is nearer than half the distance between probes; they see the rest themselves.
constexpr float kOccluded = 0.5f;

void prepare_frame(const ScreenProjection& projection, int width, int height, bool coats, DeferredFrame& frame) {
    const bool fits = frame.gbuffer && frame.gbuffer->width() == width && frame.gbuffer->height() == height;
    if (fits) {
        frame.gbuffer->projection = projection;
    } else {
        frame.gbuffer.emplace(projection, width, height, coats);
        frame.radiance = Planes3(width, height);
    }
    frame.seconds.clear();
}

} // namespace

void shade_deferred(const RasterSceneData& data, const RasterSettings& settings, const Geometry& geometry,
                    const PassView& view, const TileGrid& grid, SampleOffset offset, const Control& control,
                    DeferredFrame& frame) {
    prepare_frame(ScreenProjection(view.pinhole, offset), grid.region.width(), grid.region.height(),
                  any_clear_coat(data.scene), frame);
    GBuffer& gbuffer = *frame.gbuffer;
    Planes3& radiance = frame.radiance;
    const int threads = settings.threads;
    Stopwatch watch;
    const auto done = [&](const char* stage) { frame.seconds.emplace_back(stage, watch.lap()); };

    fill_gbuffer(data, settings, geometry, view, grid, offset, control, gbuffer, radiance);
    done("surface attributes");
    if (settings.components.direct && !data.scene.lights.empty()) {
        if (settings.shadows && data.soft_shadows) {
            const MapShadows shadows(*data.shadows, *data.soft_shadows, gbuffer.projection.eye(), view.time);
            const DirectLight light = direct_light(data, settings, gbuffer, &shadows);
            done("direct light and shadows");
            add_filtered(gbuffer, light, threads, radiance);
            done("shadow filter");
        } else {
            add(direct_light(data, settings, gbuffer, nullptr), threads, radiance);
            done("direct light");
        }
    }
    draw_background(data, settings, gbuffer, radiance);
    done("background");
    const LightComponentSet& parts = settings.components;
    const bool occluded = settings.ambient_occlusion != AmbientOcclusion::kNone;
    if (data.irradiance_probes && parts.environment) {
        const float radius = occluded ? kOccluded * data.irradiance_probes->spacing() : 0;
        frame.occlusion.compute(gbuffer, radius, threads);
        done("ambient occlusion");
        add_indirect_light(settings, gbuffer, *data.irradiance_probes, frame.occlusion, radiance);
        done("indirect light");
    } else if (shows_environment(data, settings) && parts.environment) {
        if (occluded) frame.occlusion.compute(gbuffer, static_cast<float>(occlusion_radius(data, settings)), threads);
        done("ambient occlusion");
        add_sky_light(data, settings, gbuffer, occluded ? &frame.occlusion : nullptr, radiance);
        done("sky light");
    }
    if (data.reflection_probes && parts.reflection) {
        add_reflections(data, settings, gbuffer, data.reflection_probes.get(), radiance);
        done("reflections");
        if (data.scene.needs.transmission) {
            add_refraction(data, settings, gbuffer, radiance);
            done("refraction");
        }
    }
}

std::unique_ptr<DeferredFrame> DeferredFramePool::take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<DeferredFrame>();
    std::unique_ptr<DeferredFrame> frame = std::move(free_.back());
    free_.pop_back();
    return frame;
}

void DeferredFramePool::give_back(std::unique_ptr<DeferredFrame> frame) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(frame));
}

} // namespace duet::raster

#include "raster/shading/deferred.h"

#include "raster/gbuffer/gbuffer_pass.h"
#include "raster/lighting/background.h"
#include "raster/lighting/direct_light.h"
#include "raster/lighting/shadow_filter.h"
#include "raster/lighting/sky_light.h"
#include "raster/probes/indirect_light.h"
#include "raster/probes/reflections.h"
#include "raster/probes/refraction.h"
#include "raster/shadows/shadow_map_lookup.h"

#include "common/system/control.h"
#include "common/system/stopwatch.h"

namespace duet::raster {
namespace {

/// Occlusion by what is nearer than half the distance between probes; they see the rest themselves.
constexpr float kOccluded = 0.5f;

double occlusion_radius(const RasterSceneData& data, const RasterSettings& settings) {
    if (settings.occlusion_radius > 0) return settings.occlusion_radius;
    const Camera& camera = data.scene.camera;
    return min(static_cast<double>(length(data.scene.bounds.diagonal())), length(camera.look_at - camera.eye)) / 2;
}

/// Splits the radiance into components, each of which is what the stages since the last call added.
class ComponentRecorder {
public:
    ComponentRecorder(const Planes3& radiance, int threads, LightComponentImages* components)
        : radiance_(radiance), threads_(threads), components_(components) {
        if (components_ != nullptr) before_ = Planes3(radiance.x.width(), radiance.x.height());
    }
    void record(Planes3 LightComponentImages::*component) {
        if (components_ == nullptr) return;
        Planes3& image = components_->*component;
        const bool first = image.empty();
        if (first) image = Planes3(radiance_.x.width(), radiance_.x.height());
        for_each_batch(radiance_.x.width(), radiance_.x.height(), threads_, [&](int x, int y) {
            const RgbT<Floats> now = radiance_.color(x, y), added = now - before_.color(x, y);
            image.set(x, y, first ? added : image.color(x, y) + added);
            before_.set(x, y, now);
        });
    }
    /// Records the direct light that shadows remove, from that without shadows, after the direct light itself.
    void record_shadowed(const DirectLight& unshadowed) {
        components_->shadowed = Planes3(radiance_.x.width(), radiance_.x.height());
        for_each_batch(radiance_.x.width(), radiance_.x.height(), threads_, [&](int x, int y) {
            components_->shadowed.set(x, y, unshadowed.exact.color(x, y) - components_->direct.color(x, y));
        });
    }

private:
    const Planes3& radiance_;
    int threads_;
    LightComponentImages* components_;
    Planes3 before_;
};

} // namespace

void DeferredFrame::start(const Scene& scene, const ScreenProjection& projection, int width, int height) {
    const bool fits = gbuffer && gbuffer->width() == width && gbuffer->height() == height;
    if (fits) {
        gbuffer->projection = projection;
    } else {
        gbuffer.emplace(projection, width, height, any_clear_coat(scene));
        radiance.set_size(width, height);
    }
}

void shade_gbuffer(const RasterSceneData& data, const RasterSettings& settings, const ShadeOptions& options,
                   DeferredFrame& frame) {
    const GBuffer& gbuffer = *frame.gbuffer;
    Planes3& radiance = frame.radiance;
    const int threads = settings.threads;
    ComponentRecorder recorder(radiance, threads, options.components);
    Stopwatch watch;
    const auto done = [&](const char* stage) { frame.seconds.emplace_back(stage, watch.lap()); };

    if (options.background) draw_background(data, settings, gbuffer, radiance);
    recorder.record(&LightComponentImages::emission);
    done("background");
    const LightComponentSet& parts = settings.components;
    if (parts.direct && !data.scene.lights.empty()) {
        std::optional<MapShadows> shadows;
        if (settings.shadows && data.soft_shadows) shadows.emplace(data, gbuffer, options.time, threads);
        compute_direct_light(data, settings, gbuffer, shadows ? &*shadows : nullptr, frame.direct);
        done("direct light and shadows");
        add_direct_light(gbuffer, frame.direct, threads, radiance);
        recorder.record(&LightComponentImages::direct);
        if (options.components != nullptr) {
            compute_direct_light(data, settings, gbuffer, nullptr, frame.direct);
            recorder.record_shadowed(frame.direct);
        }
        done("shadow filter");
    }
    const bool occluded = settings.ambient_occlusion;
    if (data.irradiance_probes && settings.indirect_light && parts.environment) {
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
    recorder.record(&LightComponentImages::environment);
    if (data.reflection_probes && parts.reflection) {
        add_reflections(data, settings, gbuffer, data.reflection_probes.get(), radiance);
        done("reflections");
        if (data.scene.needs.transmission) {
            add_refraction(data, settings, gbuffer, radiance);
            done("refraction");
        }
    }
    recorder.record(&LightComponentImages::reflection);
    if (!settings.fog || data.scene.media.empty()) return;
    if (options.fog == nullptr)
        frame.fog.compute(data, settings, gbuffer, ambient_light(data, settings, gbuffer.projection),
                          {.time = options.time, .background = options.background, .threads = threads});
    const FogGrid& fog = options.fog != nullptr ? *options.fog : frame.fog;
    fog.apply(gbuffer, threads, true, radiance);
    done("fog");
}

void shade_deferred(const SampleView& sample, DeferredFrame& frame) {
    const RasterSceneData& data = sample.data;
    const ScreenProjection projection(sample.view.pinhole, sample.offset);
    const int width = sample.grid.region.width(), height = sample.grid.region.height();
    frame.seconds.clear();
    frame.start(data.scene, projection, width, height);
    const Stopwatch watch;
    fill_gbuffer(data, sample.settings, sample.geometry, sample.view, sample.grid, sample.offset, sample.control,
                 *frame.gbuffer, frame.radiance);
    std::optional<BlendedLayers> layers;
    if (sample.layers != nullptr) layers.emplace(sample, *frame.gbuffer, frame.radiance);
    frame.seconds.emplace_back("surface attributes", watch.seconds());
    shade_gbuffer(data, sample.settings, {.time = sample.view.time}, frame);
    if (!layers || layers->count() == 0) return;
    layers->attenuate(frame.radiance);
    const std::unique_ptr<DeferredFrame> blended = std::make_unique<DeferredFrame>();
    blended->start(data.scene, projection, width, height);
    const Stopwatch blending;
    for (std::size_t k = 0; k < layers->count() && !sample.control.stopped(); ++k) {
        layers->fill(sample, k, *blended->gbuffer, blended->radiance);
        shade_gbuffer(data, sample.settings, {.time = sample.view.time, .background = false, .fog = &frame.fog},
                      *blended);
        layers->add(k, blended->radiance, frame.radiance);
    }
    frame.seconds.emplace_back("blended surfaces", blending.seconds());
}

} // namespace duet::raster

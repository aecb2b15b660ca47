#include "raster/shading/deferred.h"

#include "raster/gbuffer/gbuffer_pass.h"
#include "raster/lighting/background.h"
#include "raster/lighting/direct_light.h"
#include "raster/lighting/shadow_filter.h"
#include "raster/lighting/sky_light.h"
#include "raster/probes/indirect_light.h"
#include "raster/probes/reflections.h"
#include "raster/probes/refraction.h"
#include "raster/screen_space/subsurface.h"
#include "raster/shadows/shadow_map_lookup.h"

#include "common/system/control.h"
#include "common/system/stopwatch.h"

namespace duet::raster {
namespace {

/// Occluders are searched within this fraction of the distance between probes. The probes see farther occluders
/// themselves.
constexpr float kOccluded = 0.5f;

double occlusion_radius(const RasterSceneData& data, const RasterSettings& settings) {
    if (settings.occlusion_radius > 0) return settings.occlusion_radius;
    const Camera& camera = data.scene.camera;
    return min(static_cast<double>(length(data.scene.bounds.diagonal())), length(camera.look_at - camera.eye)) / 2;
}

/// Splits the radiance into components. Each component is the radiance that the stages added since the previous call of
/// record().
class ComponentRecorder {
public:
    ComponentRecorder(const Planes3& radiance, int threads, LightComponentImages* components)
        : radiance_(radiance), threads_(threads), components_(components) {
        if (components_ != nullptr) before_ = Planes3(radiance.x.width(), radiance.x.height());
    }
    bool records() const { return components_ != nullptr; }
    void record(Planes3 LightComponentImages::*component) {
        if (!records()) return;
        Planes3& image = components_->*component;
        const bool first = image.empty();
        if (first) image = Planes3(radiance_.x.width(), radiance_.x.height());
        for_each_batch(radiance_.x.width(), radiance_.x.height(), threads_, [&](int x, int y) {
            const RgbT<Floats> now = radiance_.color(x, y), added = now - before_.color(x, y);
            image.set(x, y, first ? added : image.color(x, y) + added);
            before_.set(x, y, now);
        });
    }
    /// Records the direct light that shadows remove: the unshadowed light minus the direct light, which is already
    /// recorded.
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

namespace {

/// Runs the stages of diffuse light. They also add the direct light of the other lobes.
class LightStages {
public:
    LightStages(const RasterSceneData& data, const RasterSettings& settings, const ShadeOptions& options,
                DeferredFrame& frame, Stopwatch& watch)
        : data_(data), settings_(settings), options_(options), frame_(frame), watch_(watch) {}

    void done(const char* stage) { frame_.seconds.emplace_back(stage, watch_.lap()); }

    /// Adds the light of Scene::lights.
    void add_direct(Planes3& radiance, ComponentRecorder& recorder) {
        if (!settings_.components.direct || data_.scene.lights.empty()) return;
        const GBuffer& gbuffer = *frame_.gbuffer;
        const int threads = settings_.threads;
        std::optional<MapShadows> shadows;
        if (settings_.shadows && data_.soft_shadows) shadows.emplace(data_, gbuffer, options_.time, threads);
        compute_direct_light(data_, settings_, gbuffer, shadows ? &*shadows : nullptr, frame_.direct);
        done("direct light and shadows");
        add_direct_light(gbuffer, frame_.direct, threads, radiance);
        recorder.record(&LightComponentImages::direct);
        if (recorder.records()) {
            compute_direct_light(data_, settings_, gbuffer, nullptr, frame_.direct);
            recorder.record_shadowed(frame_.direct);
        }
        done("shadow filter");
    }
    /// Adds the light of the environment and of other surfaces.
    void add_indirect(Planes3& radiance) {
        const GBuffer& gbuffer = *frame_.gbuffer;
        const int threads = settings_.threads;
        const bool occluded = settings_.ambient_occlusion;
        if (!settings_.components.environment) return;
        if (data_.irradiance_probes && settings_.indirect_light) {
            const float radius = occluded ? kOccluded * data_.irradiance_probes->spacing() : 0;
            frame_.occlusion.compute(gbuffer, radius, threads);
            done("ambient occlusion");
            add_indirect_light(settings_, gbuffer, *data_.irradiance_probes, frame_.occlusion, radiance);
            done("indirect light");
        } else if (shows_environment(data_, settings_)) {
            const auto radius = static_cast<float>(occlusion_radius(data_, settings_));
            if (occluded) frame_.occlusion.compute(gbuffer, radius, threads);
            done("ambient occlusion");
            add_sky_light(data_, settings_, gbuffer, occluded ? &frame_.occlusion : nullptr, radiance);
            done("sky light");
        }
    }
    /// Adds the light that is scattered inside solids, after their diffuse lobes are selected in the G-buffer by
    /// `lobes`.
    void add_subsurface(const SolidMaterials& materials, SolidLobes& lobes, Planes3& radiance) {
        const GBuffer& gbuffer = *frame_.gbuffer;
        const int width = gbuffer.width(), height = gbuffer.height(), threads = settings_.threads;
        lobes.show_diffuse();
        Planes3& light = frame_.solid_light = Planes3(width, height);
        ComponentRecorder none(light, threads, nullptr);
        add_direct(light, none);
        add_indirect(light);
        blur_solid_light(materials, gbuffer, threads, light);
        for_each_batch(width, height, threads,
                       [&](int x, int y) { radiance.set(x, y, radiance.color(x, y) + light.color(x, y)); });
        done("subsurface scattering");
    }

private:
    const RasterSceneData& data_;
    const RasterSettings& settings_;
    const ShadeOptions& options_;
    DeferredFrame& frame_;
    Stopwatch& watch_;
};

} // namespace

void shade_gbuffer(const RasterSceneData& data, const RasterSettings& settings, const ShadeOptions& options,
                   DeferredFrame& frame) {
    const GBuffer& gbuffer = *frame.gbuffer;
    Planes3& radiance = frame.radiance;
    const int threads = settings.threads;
    ComponentRecorder recorder(radiance, threads, options.components);
    Stopwatch watch;
    LightStages stages(data, settings, options, frame, watch);

    if (options.background) draw_background(data, settings, gbuffer, radiance);
    recorder.record(&LightComponentImages::emission);
    stages.done("background");
    {
        std::optional<SolidMaterials> solids;
        std::optional<SolidLobes> lobes; // removes the diffuse lobes of solids from the G-buffer in this scope
        // If the hits lie on the caller's own rays, neighboring pixels do not show neighboring points, so nothing is
        // blurred.
        if (settings.subsurface && data.scene.needs.subsurface && gbuffer.position.empty()) {
            solids.emplace(data.scene);
            lobes.emplace(*solids, *frame.gbuffer, threads);
        }
        stages.add_direct(radiance, recorder);
        stages.add_indirect(radiance);
        if (lobes) stages.add_subsurface(*solids, *lobes, radiance);
    }
    recorder.record(&LightComponentImages::environment);
    if (data.reflection_probes && settings.components.reflection) {
        add_reflections(data, settings, gbuffer, data.reflection_probes.get(), radiance);
        stages.done("reflections");
        if (data.scene.needs.transmission) {
            add_refraction(data, settings, gbuffer, radiance);
            stages.done("refraction");
        }
    }
    recorder.record(&LightComponentImages::reflection);
    if (!settings.fog || data.scene.media.empty()) return;
    if (options.fog == nullptr)
        frame.fog.compute(data, settings, gbuffer, ambient_light(data, settings, gbuffer.projection),
                          {.time = options.time, .background = options.background, .threads = threads});
    const FogGrid& fog = options.fog != nullptr ? *options.fog : frame.fog;
    fog.apply(gbuffer, threads, true, radiance);
    stages.done("fog");
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

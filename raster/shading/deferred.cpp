#include "raster/shading/deferred.h"

#include "raster/lighting/background.h"
#include "raster/lighting/shadow_denoiser.h"
#include "raster/lighting/sky_light.h"
#include "raster/probes/indirect_light.h"
#include "raster/probes/reflections.h"
#include "raster/probes/refraction.h"
#include "raster/screen_space/subsurface.h"
#include "raster/shading/blended_layers.h"
#include "raster/shadows/surface_shadows.h"

#include "common/system/control.h"
#include "common/system/stopwatch.h"

#include <memory>

namespace duet::raster {
namespace {

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
        gbuffer.emplace(projection, width, height, optional_planes(scene));
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

    /// Adds the light of Scene::lights and of the environment's sun.
    void add_direct(Planes3& radiance, ComponentRecorder& recorder) {
        const GBuffer& gbuffer = *frame_.gbuffer;
        const std::vector<FrameLight> lights = scene_lights(data_, settings_, gbuffer.projection),
                                      suns = sun_lights(data_, settings_, gbuffer.projection);
        if (lights.empty() && suns.empty()) return;
        const std::optional<SurfaceShadows> shadows = surface_shadows(data_, settings_, gbuffer, options_.time);
        const auto add = [&](std::span<const FrameLight> some) {
            if (some.empty()) return;
            compute_direct_light(data_, settings_, gbuffer, some, shadows ? &*shadows : nullptr, frame_.direct);
            done("direct light and shadows");
            add_direct_light(gbuffer, frame_.direct, settings_.threads, radiance);
            done("shadow denoiser");
        };
        add(lights);
        if (recorder.records() && !lights.empty()) {
            recorder.record(&LightComponentImages::direct);
            compute_direct_light(data_, settings_, gbuffer, lights, nullptr, frame_.direct);
            recorder.record_shadowed(frame_.direct);
        }
        add(suns); // recorded with the other light of the environment
    }
    /// Finds what the image's surfaces hide from each other, and the light that they send instead. `direct` returns the
    /// direct light of a pixel.
    template <typename Direct> void find_occluders(const Direct& direct) {
        const GBuffer& gbuffer = *frame_.gbuffer;
        const int threads = settings_.threads;
        const bool occluded = settings_.ambient_occlusion;
        if (uses_probes()) {
            interpolate_probes(settings_, gbuffer, *data_.irradiance_probes, frame_.occlusion);
            done("indirect light");
            const float radius = occluder_reach(settings_, *data_.irradiance_probes);
            if (settings_.components.direct || radius == 0) {
                frame_.occlusion.find_light(radius, threads, direct);
            } else {
                const Planes3 light = all_direct_light();
                frame_.occlusion.find_light(radius, threads, [&](int x, int y) { return light.color_at(x, y); });
            }
        } else if (uses_sky() && occluded) {
            frame_.occlusion.start(gbuffer, threads);
            frame_.occlusion.find_hidden(static_cast<float>(occlusion_radius(data_, settings_)), threads);
        }
        if (occluded) done("ambient occlusion");
    }
    /// Adds the light of the environment and of other surfaces, after find_occluders().
    void add_indirect(Planes3& radiance) {
        const GBuffer& gbuffer = *frame_.gbuffer;
        if (uses_probes()) {
            add_indirect_light(settings_, gbuffer, *data_.irradiance_probes, frame_.occlusion, radiance);
            done("indirect light");
        } else if (uses_sky()) {
            const GtaoImage* occlusion = settings_.ambient_occlusion ? &frame_.occlusion : nullptr;
            add_sky_light(data_, settings_, gbuffer, occlusion, radiance);
            done("sky light");
        }
    }

private:
    /// Returns the direct light of an image in which it is not selected.
    Planes3 all_direct_light() {
        RasterSettings settings = settings_;
        settings.components = {};
        Planes3 light(frame_.gbuffer->width(), frame_.gbuffer->height());
        ComponentRecorder none(light, settings.threads, nullptr);
        LightStages(data_, settings, options_, frame_, watch_).add_direct(light, none);
        return light;
    }
    bool uses_probes() const {
        return settings_.components.environment && data_.irradiance_probes && settings_.indirect_light;
    }
    bool uses_sky() const {
        return settings_.components.environment && !uses_probes() && shows_environment(data_, settings_);
    }

    const RasterSceneData& data_;
    const RasterSettings& settings_;
    const ShadeOptions& options_;
    DeferredFrame& frame_;
    Stopwatch& watch_;
};

/// Adds the light that diffuse lobes reflect, and the direct light of the other lobes.
void add_diffuse_light(LightStages& stages, ComponentRecorder& recorder, Planes3& radiance) {
    stages.add_direct(radiance, recorder);
    stages.find_occluders([&](int x, int y) { return radiance.color_at(x, y); });
    stages.add_indirect(radiance);
}

/// Does the same in a scene with solids, whose diffuse light is scattered inside of them.
void add_diffuse_light(LightStages& stages, const SolidMaterials& materials, DeferredFrame& frame, int threads,
                       ComponentRecorder& recorder) {
    GBuffer& gbuffer = *frame.gbuffer;
    Planes3& radiance = frame.radiance;
    Planes3& inside = frame.solid_light = Planes3(gbuffer.width(), gbuffer.height());
    ComponentRecorder none(inside, threads, nullptr);
    SolidLobes lobes(materials, gbuffer, threads);
    lobes.show(Lobes::kSolids);
    stages.add_direct(inside, none);
    lobes.show(Lobes::kOthers);
    stages.add_direct(radiance, recorder);
    lobes.show(Lobes::kAll);
    stages.find_occluders([&](int x, int y) { return radiance.color_at(x, y) + inside.color_at(x, y); });
    lobes.show(Lobes::kSolids);
    stages.add_indirect(inside);
    blur_solid_light(materials, gbuffer, threads, inside);
    stages.done("subsurface scattering");
    lobes.show(Lobes::kOthers);
    stages.add_indirect(radiance);
    for_each_batch(gbuffer.width(), gbuffer.height(), threads,
                   [&](int x, int y) { radiance.set(x, y, radiance.color(x, y) + inside.color(x, y)); });
}

} // namespace

void shade_gbuffer(const RasterSceneData& data, const RasterSettings& settings, const ShadeOptions& options,
                   DeferredFrame& frame) {
    const GBuffer& gbuffer = *frame.gbuffer;
    Planes3& radiance = frame.radiance;
    const int threads = settings.threads;
    ComponentRecorder recorder(radiance, threads, options.components);
    Stopwatch watch;
    LightStages stages(data, settings, options, frame, watch);

    if (options.background) draw_background(data, settings, gbuffer, true, radiance);
    recorder.record(&LightComponentImages::emission);
    stages.done("background");
    // If the hits lie on the caller's own rays, neighboring pixels do not show neighboring points, so nothing is
    // blurred.
    if (settings.subsurface && data.scene.needs.subsurface && gbuffer.position.empty())
        add_diffuse_light(stages, SolidMaterials(data.scene), frame, threads, recorder);
    else
        add_diffuse_light(stages, recorder, radiance);
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
    const BlendedLayers layers(sample, *frame.gbuffer, frame.radiance);
    frame.seconds.emplace_back("surface attributes", watch.seconds());
    shade_gbuffer(data, sample.settings, {.time = sample.view.time}, frame);
    if (layers.count() == 0) return;
    layers.attenuate(frame.radiance);
    const std::unique_ptr<DeferredFrame> blended = std::make_unique<DeferredFrame>();
    blended->start(data.scene, projection, width, height);
    const Stopwatch blending;
    for (std::size_t k = 0; k < layers.count() && !sample.control.stopped(); ++k) {
        layers.fill(sample, k, *blended->gbuffer, blended->radiance);
        shade_gbuffer(data, sample.settings, {.time = sample.view.time, .background = false, .fog = &frame.fog},
                      *blended);
        layers.add(k, blended->radiance, frame.radiance);
    }
    frame.seconds.emplace_back("blended surfaces", blending.seconds());
}

} // namespace duet::raster

#include "compare/renderer.h"

#include "common/system/stopwatch.h"
#include "raster/render.h"
#include "raytrace/render.h"

namespace duet::compare {

namespace {

/// Returns the settings reduced to one sample per pixel and the hit AOV alone.
template <typename Settings> Settings hits_only(Settings settings) {
    settings.samples_per_pixel = 1;
    settings.aovs = AovSet{};
    settings.aovs.hit = true;
    return settings;
}

raster::RasterSettings raster_settings(const ComparisonSettings& common) {
    raster::RasterSettings settings;
    settings.samples_per_pixel = common.raster_spp;
    settings.threads = common.threads;
    settings.seed = common.seed;
    return settings;
}
raster::RasterSettings hit_settings(const raster::RasterSettings& settings) {
    raster::RasterSettings hits = hits_only(settings);
    hits.shading = raster::Shading::kNormal; // cheapest shading: only the hits are used
    return hits;
}

raytrace::PathTracerSettings path_tracer_settings(const ComparisonSettings& common) {
    raytrace::PathTracerSettings settings;
    settings.samples_per_pixel = common.raytrace_spp;
    settings.max_depth = common.max_depth;
    settings.threads = common.threads;
    settings.seed = common.seed;
    return settings;
}
raytrace::PathTracerSettings hit_settings(const raytrace::PathTracerSettings& settings) {
    raytrace::PathTracerSettings hits = hits_only(settings);
    hits.sampler = SamplerKind::kCenter;
    hits.integrator = raytrace::Integrator::kNormal;
    return hits;
}

template <typename Prepared, typename Settings>
RenderFunction render_function(const Prepared& prepared, const Settings& settings) {
    return [prepared, settings](const View& view, Control& control) {
        return render(prepared, view, settings, control);
    };
}

template <typename Settings>
Renderer renderer(std::string name, const Scene& scene, const Settings& settings) {
    const Stopwatch watch;
    const auto prepared = prepare(scene, settings);
    return {std::move(name), render_function(prepared, settings), render_function(prepared, hit_settings(settings)),
            watch.seconds()};
}

template <typename Settings> RenderFunction hits(const Scene& scene, const Settings& settings) {
    return render_function(prepare(scene, hit_settings(settings)), hit_settings(settings));
}

} // namespace

Renderer raster_renderer(const Scene& scene, const ComparisonSettings& settings) {
    return renderer("raster", scene, raster_settings(settings));
}
Renderer raytrace_renderer(const Scene& scene, const ComparisonSettings& settings) {
    return renderer("raytrace", scene, path_tracer_settings(settings));
}

RenderFunction raster_hits(const Scene& scene, const ComparisonSettings& settings) {
    return hits(scene, raster_settings(settings));
}
RenderFunction raytrace_hits(const Scene& scene, const ComparisonSettings& settings) {
    return hits(scene, path_tracer_settings(settings));
}

View scene_view(const Scene& scene) { return {scene.camera, scene.width, scene.height}; }

} // namespace duet::compare

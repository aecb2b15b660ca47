#include "compare/renderer.h"

#include "common/system/stopwatch.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

/// Reduces the settings to one sample per pixel and the hit AOV alone.
template <typename Settings> void keep_hits_only(Settings& settings) {
    settings.samples_per_pixel = 1;
    settings.aovs = AovSet{};
    settings.aovs.hit = true;
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

raster::RasterSettings raster_settings(const ComparisonSettings& common) {
    raster::RasterSettings settings;
    settings.samples_per_pixel = common.raster_spp;
    settings.threads = common.threads;
    settings.seed = common.seed;
    return settings;
}

raytrace::PathTracerSettings path_tracer_settings(const ComparisonSettings& common) {
    raytrace::PathTracerSettings settings;
    settings.samples_per_pixel = common.raytrace_spp;
    settings.max_depth = common.max_depth;
    settings.threads = common.threads;
    settings.seed = common.seed;
    return settings;
}

raster::RasterSettings hit_settings(raster::RasterSettings settings) {
    keep_hits_only(settings);
    settings.shading = raster::Shading::kNormal; // cheapest shading: only the hits are used
    return settings;
}

raytrace::PathTracerSettings hit_settings(raytrace::PathTracerSettings settings) {
    keep_hits_only(settings);
    settings.sampler = SamplerKind::kCenter;
    settings.integrator = raytrace::Integrator::kNormal;
    return settings;
}

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

View scaled(View view, double scale) {
    for (int* side : {&view.width, &view.height}) *side = std::max(1, static_cast<int>(std::lround(*side * scale)));
    return view;
}

View scene_view(const Scene& scene, ImageSize size, double scale) {
    if (size.width > 0) return {scene.camera, size.width, size.height};
    return scaled(scene_view(scene), scale);
}

} // namespace duet::compare

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

} // namespace

Renderer raster_renderer(const Scene& scene, const ComparisonSettings& common) {
    raster::RasterSettings settings;
    settings.samples_per_pixel = common.raster_spp;
    settings.threads = common.threads;
    settings.seed = common.seed;
    raster::RasterSettings hits = hits_only(settings);
    hits.shading = raster::Shading::kNormal; // cheapest shading: only the hits are used

    const Stopwatch watch;
    const raster::RasterScene prepared = raster::prepare(scene, settings);
    const auto render_function = [prepared](const raster::RasterSettings& s) -> RenderFunction {
        return [prepared, s](const View& view, Control& control) { return raster::render(prepared, view, s, control); };
    };
    return {"raster", render_function(settings), render_function(hits), watch.seconds()};
}

Renderer raytrace_renderer(const Scene& scene, const ComparisonSettings& common) {
    raytrace::PathTracerSettings settings;
    settings.samples_per_pixel = common.raytrace_spp;
    settings.max_depth = common.max_depth;
    settings.threads = common.threads;
    settings.seed = common.seed;
    raytrace::PathTracerSettings hits = hits_only(settings);
    hits.sampler = SamplerKind::kCenter;
    hits.integrator = raytrace::Integrator::kNormal;

    const Stopwatch watch;
    const raytrace::PathTracerScene prepared = raytrace::prepare(scene, settings);
    const auto render_function = [prepared](const raytrace::PathTracerSettings& s) -> RenderFunction {
        return
            [prepared, s](const View& view, Control& control) { return raytrace::render(prepared, view, s, control); };
    };
    return {"raytrace", render_function(settings), render_function(hits), watch.seconds()};
}

std::string paragraph(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences) text += (text.empty() ? "" : " ") + sentence;
    return text;
}

} // namespace duet::compare

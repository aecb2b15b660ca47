#include "compare/pipeline.h"

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

Pipeline raster_pipeline(const Scene& scene, const PipelineSettings& common) {
    raster::Settings settings;
    settings.samples_per_pixel = common.raster_spp;
    settings.threads = common.threads;
    settings.seed = common.seed;
    raster::Settings hits = hits_only(settings);
    hits.shading = raster::Shading::kNormal; // cheapest shading: only the hits are used

    const Stopwatch watch;
    const raster::Prepared prepared = raster::prepare(scene, settings);
    const auto renderer = [prepared](const raster::Settings& s) -> RenderFunction {
        return [prepared, s](const View& view, Control& control) { return raster::render(prepared, view, s, control); };
    };
    return {"raster", renderer(settings), renderer(hits), watch.seconds()};
}

Pipeline raytrace_pipeline(const Scene& scene, const PipelineSettings& common) {
    raytrace::Settings settings;
    settings.samples_per_pixel = common.raytrace_spp;
    settings.max_depth = common.max_depth;
    settings.threads = common.threads;
    settings.seed = common.seed;
    raytrace::Settings hits = hits_only(settings);
    hits.sampler = SamplerKind::kCenter;
    hits.integrator = raytrace::Integrator::kNormal;

    const Stopwatch watch;
    const raytrace::Prepared prepared = raytrace::prepare(scene, settings);
    const auto renderer = [prepared](const raytrace::Settings& s) -> RenderFunction {
        return
            [prepared, s](const View& view, Control& control) { return raytrace::render(prepared, view, s, control); };
    };
    return {"raytrace", renderer(settings), renderer(hits), watch.seconds()};
}

std::string paragraph(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences) text += (text.empty() ? "" : " ") + sentence;
    return text;
}

} // namespace duet::compare

#include "compare/ladder/measure_rungs.h"

#include "common/sampling/hash.h"
#include "common/system/stopwatch.h"

#include <cmath>

namespace duet::compare {

namespace {

/// These are the approximate costs of a sample relative to a path-traced one, for the progress bar.
constexpr double kRasterCost = 0.1, kRayCost = 0.4;

struct Rendered {
    MeasuredRender side;
    Image<Hit> hits;
};

Rendered render_timed(const RenderFunction& render, int spp, const View& view, Control& control) {
    const Stopwatch watch;
    Rendering rendering = render(view, control);
    return {{std::move(rendering.radiance), watch.seconds(), spp}, std::move(rendering.hit)};
}

MeasuredQuantity measure(const RungRenderers& renderers, const Scene& scene, const View& view, int threads,
                         const NextTask& next_task) {
    Control raster = next_task(kRasterCost * renderers.raster_settings.samples_per_pixel);
    Rendered a = render_timed(renderers.raster, renderers.raster_settings.samples_per_pixel, view, raster);
    Control raytrace = next_task(kRayCost * renderers.raytrace_settings.samples_per_pixel);
    Rendered b = render_timed(renderers.raytrace, renderers.raytrace_settings.samples_per_pixel, view, raytrace);
    MeasuredQuantity result{renderers.name, std::move(a.side), std::move(b.side), {}, {}};
    if (raytrace.stopped()) return result;
    if (a.hits.empty()) {
        result.error = error_metrics(result.raster.image, result.raytrace.image);
    } else {
        result.hits = compare_hits(scene, view, a.hits, b.hits, threads);
        result.raster.image = hit_image(a.hits);
        result.raytrace.image = hit_image(b.hits);
    }
    return result;
}

} // namespace

double measuring_cost(const std::array<RungPlan, kRungCount>& plan) {
    double cost = 0;
    for (const RungPlan& rung : plan)
        for (const RungRenderers& q : rung.renderers)
            cost +=
                kRasterCost * q.raster_settings.samples_per_pixel + kRayCost * q.raytrace_settings.samples_per_pixel;
    return cost;
}

std::array<MeasuredRung, kRungCount> measure_rungs(const Scene& scene, const View& view,
                                                   const std::array<RungPlan, kRungCount>& plan, int threads,
                                                   const NextTask& next_task) {
    std::array<MeasuredRung, kRungCount> rungs;
    for (std::size_t k = 0; k < kRungCount; ++k)
        for (const RungRenderers& renderers : plan[k].renderers)
            rungs[k].push_back(measure(renderers, scene, view, threads, next_task));
    return rungs;
}

ImageRgb hit_image(const Image<Hit>& hits) {
    ImageRgb image(hits.width(), hits.height(), Rgb(0.01f));
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) continue;
        // Multiples of the golden ratio distribute any number of hues evenly.
        const double hue = 2 * kPiDouble * std::fmod(hits[i].object * 0.6180339887498949, 1.0);
        const float shade = 0.25f + 0.75f * unit_float(high_bits(mix_bits(hits[i].primitive + 1)));
        const auto channel = [&](double turn) {
            return shade * static_cast<float>(sqr(0.55 + 0.45 * std::cos(hue - turn * 2 * kPiDouble / 3)));
        };
        image[i] = {channel(0), channel(1), channel(2)};
    }
    return image;
}

} // namespace duet::compare

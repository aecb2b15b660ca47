#include "compare/ladder/measure.h"

#include "common/sampling/hash.h"
#include "common/system/stopwatch.h"

#include <cmath>

namespace duet::compare {

namespace {

/// Approximate cost of a sample relative to a path-traced one, for the progress bar.
constexpr double kRasterCost = 0.1, kRayCost = 0.4;

struct Rendered {
    MeasuredSide side;
    Image<Hit> hits;
};

Rendered render_timed(const RenderFunction& render, int spp, const View& view, Control& control) {
    const Stopwatch watch;
    Rendering rendering = render(view, control);
    return {{std::move(rendering.radiance), watch.seconds(), spp}, std::move(rendering.hit)};
}

MeasuredQuantity measure(const Quantity& quantity, const Scene& scene, const View& view, int threads,
                         const NextTask& next_task) {
    Control raster = next_task(kRasterCost * quantity.raster_spp);
    Rendered a = render_timed(quantity.raster, quantity.raster_spp, view, raster);
    Control raytrace = next_task(kRayCost * quantity.raytrace_spp);
    Rendered b = render_timed(quantity.raytrace, quantity.raytrace_spp, view, raytrace);
    MeasuredQuantity result{quantity.name, std::move(a.side), std::move(b.side), {}, {}};
    if (raytrace.stopped()) return result;
    if (a.hits.empty()) {
        result.error = error_metrics(result.raster.picture, result.raytrace.picture);
    } else {
        result.hits = compare_hits(scene, view, a.hits, b.hits, threads);
        result.raster.picture = hit_picture(a.hits);
        result.raytrace.picture = hit_picture(b.hits);
    }
    return result;
}

} // namespace

double measuring_cost(const std::array<RungPlan, kRungCount>& plan) {
    double cost = 0;
    for (const RungPlan& rung : plan)
        for (const Quantity& q : rung.quantities) cost += kRasterCost * q.raster_spp + kRayCost * q.raytrace_spp;
    return cost;
}

std::array<MeasuredRung, kRungCount> measure_rungs(const Scene& scene, const View& view,
                                                   const std::array<RungPlan, kRungCount>& plan, int threads,
                                                   const NextTask& next_task) {
    std::array<MeasuredRung, kRungCount> rungs;
    for (std::size_t k = 0; k < kRungCount; ++k)
        for (const Quantity& quantity : plan[k].quantities)
            rungs[k].push_back(measure(quantity, scene, view, threads, next_task));
    return rungs;
}

ImageRgb hit_picture(const Image<Hit>& hits) {
    ImageRgb picture(hits.width(), hits.height(), Rgb(0.01f));
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) continue;
        // Multiples of the golden ratio distribute any number of hues evenly.
        const double hue = 2 * kPiDouble * std::fmod(hits[i].object * 0.6180339887498949, 1.0);
        const float shade = 0.25f + 0.75f * unit_float(high_bits(mix_bits(hits[i].primitive + 1)));
        const auto channel = [&](double turn) {
            return shade * static_cast<float>(sqr(0.55 + 0.45 * std::cos(hue - turn * 2 * kPiDouble / 3)));
        };
        picture[i] = {channel(0), channel(1), channel(2)};
    }
    return picture;
}

} // namespace duet::compare

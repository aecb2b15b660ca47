// This file renders the rungs of the ladder: each quantity separately in both pipelines, with its time and error.
#pragma once

#include "compare/hits/hit_agreement.h"
#include "compare/ladder/rungs.h"
#include "compare/metrics/error_metrics.h"

#include <functional>
#include <optional>

namespace duet::compare {

/// Holds one pipeline's image of a quantity, and its cost.
struct MeasuredRender {
    ImageRgb image; ///< linear; false colors for hits
    double seconds = 0;
    int samples_per_pixel = 0;
};
/// Holds a quantity as both pipelines rendered it.
struct MeasuredQuantity {
    std::string name;
    MeasuredRender raster, raytrace;
    ErrorMetrics error;               ///< of the rasterizer's image against the path tracer's; zero for hits
    std::optional<HitAgreement> hits; ///< present for rung 1 only
};
using MeasuredRung = std::vector<MeasuredQuantity>;

/// Returns a Control for the next task. `cost` is its expected cost in path-traced samples per pixel.
using NextTask = std::function<Control(double cost)>;
/// Returns the total cost of all tasks of the plan.
double measuring_cost(const std::array<RungPlan, kRungCount>& plan);

/// Renders what the plan specifies. If stopped, returns what is finished.
std::array<MeasuredRung, kRungCount> measure_rungs(const Scene& scene, const View& view,
                                                   const std::array<RungPlan, kRungCount>& plan, int threads,
                                                   const NextTask& next_task);

/// Returns the hits in false colors: each object has its own hue, each primitive its own shade of that hue, and misses
/// are dark.
ImageRgb hit_image(const Image<Hit>& hits);

} // namespace duet::compare

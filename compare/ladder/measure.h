// Renders the rungs of the ladder: each quantity by itself, both ways, with its time and error.
#pragma once

#include "compare/hits/hit_agreement.h"
#include "compare/ladder/rungs.h"
#include "compare/metrics/error_metrics.h"

#include <functional>
#include <optional>

namespace duet::compare {

struct MeasuredSide {
    ImageRgb picture; ///< linear; of hits: false colours
    double seconds = 0;
    int samples_per_pixel = 0;
};
struct MeasuredQuantity {
    std::string name;
    MeasuredSide raster, raytrace;
    ErrorMetrics error;               ///< of the rasterizer's from the path tracer's; of hits: zero
    std::optional<HitAgreement> hits; ///< of rung 1
};
using MeasuredRung = std::vector<MeasuredQuantity>;

/// Hands out a Control for the next task, whose expected cost is given as a number of path-traced samples a pixel.
using NextTask = std::function<Control(double cost)>;
/// The tasks' costs together.
double measuring_cost(const std::array<RungPlan, kRungCount>& plan);

/// Renders what the plan says. Stopped, it returns what is finished.
std::array<MeasuredRung, kRungCount> measure_rungs(const Scene& scene, const View& view,
                                                   const std::array<RungPlan, kRungCount>& plan, int threads,
                                                   const NextTask& next_task);

/// Each object has a hue of its own, its primitives shades of it; what hits nothing is dark.
ImageRgb hit_picture(const Image<Hit>& hits);

} // namespace duet::compare

// Declares a pass over the whole image. A render consists of passes, and each adds some samples to its pixels.
#pragma once

#include "common/system/control.h"
#include "raytrace/aov.h"
#include "raytrace/film/film.h"
#include "raytrace/film/film_checkpoint.h"
#include "raytrace/integrator/integrator.h"

namespace duet::raytrace {

/// Returns the camera ray of pixel (x, y) for the sampler's current sample.
Ray camera_ray(const RenderPlan& plan, const CameraModel& camera, int x, int y, const Sampler& sampler);

/// Holds everything that a pass reads, and everything that it modifies.
struct PassContext {
    const RenderPlan& plan;
    const View& view;
    const PathTracerSettings& settings;
    Control& control;
    FilmCheckpoint& checkpoint;
    AovBuffers& aovs;
    RayCounts& counts;
    std::optional<InvalidSample>& first_invalid;
};

/// Renders the samples that the film's pixels lack to reach their targets (Film::Pixel::target), tile by tile on all
/// threads. Returns false if it was stopped: tiles in progress are finished, and the others are left out. Reports
/// progress from `begin` to `end`.
bool render_pass(const PassContext& context, double begin, double end);

} // namespace duet::raytrace

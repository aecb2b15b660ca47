// A render's passes over the whole picture, each some samples of its pixels.
#pragma once

#include "common/film/film.h"
#include "raytrace/aov.h"
#include "raytrace/film_keeper.h"
#include "raytrace/integrator/integrator.h"

namespace duet::raytrace {

/// The camera ray of the sample that the sampler stands at, of pixel (x, y).
Ray camera_ray(const RenderPlan& plan, const CameraModel& camera, int x, int y, const Sampler& sampler);

/// Everything that a pass reads and adds to.
struct PassTarget {
    const RenderPlan& plan;
    const View& view;
    const Settings& settings;
    Control& control;
    FilmKeeper& keeper;
    AovBuffers& aovs;
    RayCounts& counts;
    std::optional<InvalidSample>& first_invalid;
};

/// Renders the samples that the film's pixels have been promised and do not have yet, tile by tile on all threads. False
/// where it was stopped: tiles at hand are finished, others left out. Reports progress from `begin` to `end`.
bool render_pass(const PassTarget& target, double begin, double end);

} // namespace duet::raytrace

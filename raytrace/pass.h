// A render's passes over the whole picture, each a range of samples of every pixel.
#pragma once

#include "common/film/film.h"
#include "raytrace/aov.h"
#include "raytrace/film_keeper.h"
#include "raytrace/integrator/integrator.h"

#include <optional>

namespace duet::raytrace {

/// Samples [first, last) of each pixel, counted from Settings::first_sample.
struct SampleRange {
    std::uint32_t first, last;
};

/// The next pass after `done` samples a pixel, those of `done` taken within `seconds` by this render, or none where a
/// limit is reached: the number of samples, the time, or the error (of the film). Without limits of time and error passes are of 16 samples; with them
/// they start with 2, one for each replicate, and grow with what is done, so that the end comes near the limit. A pass
/// that would end farther beyond the time limit than it begins before it is not begun.
std::optional<SampleRange> next_pass(const Settings& settings, SampleRange done, double seconds, const Film& film);

/// The camera ray of the sample that the sampler stands at, of pixel (x, y).
Ray camera_ray(const RenderPlan& plan, const CameraModel& camera, int x, int y, Sampler& sampler);

/// Everything that a pass reads and adds to.
struct PassTarget {
    const RenderPlan& plan;
    const View& view;
    const Settings& settings;
    Control& control;
    FilmKeeper& keeper;
    AovBuffers& aovs;
    RayCounts& counts;
};

/// Renders those samples of a pass that the film does not have yet, tile by tile on all threads. False where it was stopped: tiles at hand are finished,
/// others left out. Reports progress from `begin` to `end`.
bool render_pass(const PassTarget& target, SampleRange range, double begin, double end);

} // namespace duet::raytrace

// Declares RenderState, the state that a render keeps from pass to pass.
#pragma once

#include "raytrace/render_pass.h"

namespace duet::raytrace {

/// Holds the film, the auxiliary images and the counts of a render. It refers to its arguments, which must outlive it.
struct RenderState {
    /// Throws Error for the same arguments as render().
    RenderState(const PathTracerSceneData& prepared, const View& view_, const PathTracerSettings& settings_);

    const View& view;
    const PathTracerSettings& settings;
    const RenderPlan plan;
    FilmCheckpoint checkpoint;
    AovBuffers aovs;
    RayCounts rays;
    std::optional<InvalidSample> first_invalid;

    /// Renders the samples that the film's pixels lack to reach their targets. See render_pass.
    bool run_pass(Control& control, double begin, double end);
};

} // namespace duet::raytrace

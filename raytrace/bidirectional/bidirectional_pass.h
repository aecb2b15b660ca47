// Declares a pass of bidirectional path tracing. It takes a sample of all pixels together, because a light subpath may
// reach any pixel.
#pragma once

#include "raytrace/render_pass.h"

namespace duet::raytrace {

/// Throws Error if the scene or the settings request something that bidirectional path tracing does not support.
void check_bidirectional(const Scene& scene, const PathTracerSettings& settings);

/// Renders the samples that the film's pixels lack to reach their targets, which must be equal. See render_pass. A
/// sample of a pixel is the light of its camera subpath and of all light subpaths of the same sample that reach the
/// pixel. If the pass is stopped, the film keeps none of the unfinished sample.
bool render_bidirectional_pass(const PassContext& context, double begin, double end);

} // namespace duet::raytrace

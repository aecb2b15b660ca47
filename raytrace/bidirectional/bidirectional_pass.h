// A pass of bidirectional path tracing takes samples of all pixels together, because light subpaths reach any pixel.
#pragma once

#include "raytrace/render_pass.h"

namespace duet::raytrace {

/// Throws Error where the scene or the settings ask for something that bidirectional path tracing does not support.
void check_bidirectional(const Scene& scene, const PathTracerSettings& settings);

/// Renders the samples that the film's pixels lack to reach their targets, which must be equal. See render_pass. A
/// sample of a pixel is what its camera subpath finds and what the light subpaths of the same sample of all pixels send
/// to it. Stopped samples leave no trace in the film.
bool render_bidirectional_pass(const PassContext& context, double begin, double end);

} // namespace duet::raytrace

// This header declares tests of the group "projection" with their own files; projection_tests.cpp has their rows.
#pragma once

#include "compare/stress/trials.h"

namespace duet::compare {

/// Runs a trial of projection/once-clipped, on a floor that reaches below and behind the eye.
void clipped_floor(Trial& trial);
/// Runs a trial of projection/depth-order, on two parallel surfaces a few floats apart.
void depth_order(Trial& trial);
/// Runs a trial of projection/draw-order, on triangles at the same place and depth.
void draw_order(Trial& trial);

} // namespace duet::compare

// This file declares the tests of the group "projection" that have their own files; projection_tests.cpp lists them.
#pragma once

#include "compare/stress/trials.h"

namespace duet::compare {

/// Runs a trial of projection/once-clipped, on a floor that reaches below and behind the eye.
void clipped_floor(Trial& trial);
/// Runs a trial of projection/depth-order, on two parallel surfaces a few floats apart.
void depth_order(Trial& trial);
/// Runs a trial of projection/draw-order, on overlapping triangles of equal depth.
void draw_order(Trial& trial);

} // namespace duet::compare

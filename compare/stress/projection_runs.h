// This header declares tests of the group "projection" with their own files; projection_tests.cpp has their rows.
#pragma once

#include "compare/stress/trials.h"

namespace duet::compare {

void clipped_floor(Trial& trial);
void depth_order(Trial& trial);
void draw_order(Trial& trial);

} // namespace duet::compare

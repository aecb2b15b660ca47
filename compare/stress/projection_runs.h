// This header declares tests of the group "projection" with their own files; projection_tests.cpp has their rows.
#pragma once

#include "compare/stress/stress.h"

namespace duet::compare {

StressResult clipped_floor(const StressTest& test, const StressSetting& setting);
StressResult depth_order(const StressTest& test, const StressSetting& setting);
StressResult draw_order(const StressTest& test, const StressSetting& setting);

} // namespace duet::compare

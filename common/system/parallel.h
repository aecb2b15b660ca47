// This file declares parallel loops.
#pragma once

#include <cstddef>
#include <functional>

namespace duet {

/// Returns the number of logical processors that this process may use, at least 1. Where a thread count is 0 ("all"),
/// it stands for this number.
int available_threads();

/// Calls body(i) once for each i in [0, count), on `threads` threads (0: all), in no fixed order. Returns after all
/// calls have returned. If a body throws, the loop stops early and the first exception is rethrown. Different bodies
/// should write to different cache lines, because false sharing prevents scaling.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

} // namespace duet

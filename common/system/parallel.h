// Parallel loops.
#pragma once

#include <cstddef>
#include <functional>

namespace duet {

/// The number of threads that `threads` = 0 («all») stands for here: the processors this process may use.
int available_threads();

/// Calls body(i) once for each i in [0, count), on `threads` threads (0: all), in no fixed order. Returns when all
/// calls have. The first exception thrown by a body is thrown again here, after the loop has stopped. Bodies that
/// write results write each to its own cache lines, or scaling is lost.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

} // namespace duet

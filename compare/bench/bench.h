// `compare bench`: measures run time against error.
#pragma once

#include "compare/bench/bench_options.h"

namespace duet::compare {

/// Measures the scenes one after the other, prints tables and writes the report. Returns 0 on success, and 1 if two
/// independent references of a scene disagree or if the baseline comparison finds a row slower or less accurate.
/// Returns 130 after an interrupt signal; no report is written then, but finished references stay in the cache. Throws
/// Error for scenes, options and files that cannot be used.
int bench(const BenchOptions& options);

} // namespace duet::compare

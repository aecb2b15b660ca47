// This file times several implementations of the same work in turns, so that changes of the CPU's speed do not affect
// their ratio.
#pragma once

#include "common/system/control.h"
#include "compare/kernels/tracer.h"
#include "compare/timing.h"

#include <functional>
#include <string>
#include <vector>

namespace duet::compare {

/// Returns the range of at least one value. The median of an even number of values is the lower of the middle two.
MedianRange median_range(std::vector<double> values);

/// Does the work once and returns the seconds it took.
using TimedWork = std::function<double()>;

/// Returns a stopwatch for work on `threads` threads: CPU time for a single thread, wall-clock time for several.
inline WorkStopwatch work_stopwatch(int threads) { return WorkStopwatch(threads == 1); }

/// Holds one peer's timings beside ours.
struct PairedTiming {
    MedianRange ratio;           ///< peer's seconds / ours, for measurements adjacent in time: above 1, Duet is faster
    double ours = 0, theirs = 0; ///< seconds of the pair with the median ratio
};
/// Holds timings of Duet and of its peers, measured in turns.
struct InterleavedTimings {
    double seconds = 0; ///< Duet's median, also without peers
    int repeats = 0;
    std::vector<PairedTiming> peers; ///< in the order given
};

/// With fewer measurements, there is no verdict on which side is faster.
inline constexpr int kMinRepeatsForVerdict = 5;

/// Measures in rounds. In each round, `ours` runs before, between and after every two peers, so that each peer
/// is adjacent to it: ours, A, B, ours, C, D, ours … Makes at least kMinRepeatsForVerdict rounds if `repeats` allows
/// it, then up to `repeats` while less than `time_limit` seconds have passed. The result is meaningless if
/// `control` was stopped.
InterleavedTimings interleave(const TimedWork& ours, const std::vector<TimedWork>& peers, int repeats,
                              double time_limit, const Control& control);

/// A RaySubset is the part of a ray set that one measurement traces: whole groups of blocks, spread evenly over the
/// set, so that tracing takes about the requested time.
struct RaySubset {
    std::size_t rays = 0;            ///< number of rays traced, over all passes
    std::vector<std::size_t> groups; ///< groups of kGroup blocks each
    int passes = 1;

    static constexpr std::size_t kGroup = 4;
};
/// Returns a subset of a set of `rays` rays that takes about `seconds` with a tracer of `rate` rays per second.
RaySubset choose_ray_subset(std::size_t rays, double rate, double seconds);

/// Returns the seconds (work_stopwatch) to trace the subset on `threads` threads. `ray_results` has one element per
/// block of the whole set.
double trace_seconds(const Tracer& tracer, const RaySubset& subset, int threads,
                     std::vector<RayResultBlock>& ray_results);

} // namespace duet::compare

// Two ways of doing one thing, timed in turns: ratios that a machine's changing pace leaves alone.
#pragma once

#include "common/system/control.h"
#include "common/system/stopwatch.h"
#include "compare/kernels/tracer.h"

#include <ctime>
#include <functional>
#include <string>
#include <vector>

namespace duet::compare {

struct Range {
    double min = 0, median = 0, max = 0;
};
/// Of at least one value; the median of an even number is the lower one of the middle two.
Range range_of(std::vector<double> values);

/// Does the work once and returns the seconds it took.
using Timed = std::function<double()>;

/// Measures work that `threads` threads do: of one thread its CPU time, which other programs on the machine disturb much
/// less; of several the time that passes.
class WorkWatch {
public:
    explicit WorkWatch(int threads) : alone_(threads == 1), begin_(std::clock()) {}
    double seconds() const {
        return alone_ ? static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC : watch_.seconds();
    }

private:
    bool alone_;
    std::clock_t begin_; ///< of the process, whose other threads sleep
    Stopwatch watch_;
};

struct Versus {
    Range ratio;                 ///< peer's seconds / ours, of neighbours in time: above 1 ours is ahead
    double ours = 0, theirs = 0; ///< seconds of the pair of the median ratio, which is their quotient
};
struct Interleaved {
    double seconds = 0; ///< our median, beside whatever peers
    int repeats = 0;
    std::vector<Versus> peers; ///< in the order given
};

/// Fewer measurements than these say nothing of who is ahead.
inline constexpr int kLeastForVerdict = 5;

/// In each round ours runs before, between and after every two peers, so that each peer has ours for a neighbour: ours,
/// A, B, ours, C, D, ours … At least kLeastForVerdict rounds, then up to `repeats` while less than `time_limit` seconds have gone.
/// What is found means nothing where `control` was stopped.
Interleaved interleave(const Timed& ours, const std::vector<Timed>& peers, int repeats, double time_limit,
                       const Control& control);

/// The part of a set of rays that one measurement traces: whole groups of blocks, spread evenly over the set, so that
/// it takes about as long as was asked for.
struct Portion {
    std::size_t rays = 0;            ///< traced in all
    std::vector<std::size_t> groups; ///< of kGroup blocks each
    int passes = 1;

    static constexpr std::size_t kGroup = 4;
};
/// For the set of `rays` that a tracer traces at `rate` rays a second.
Portion portion_of(std::size_t rays, double rate, double seconds);

/// Seconds (WorkWatch) that the tracer takes for the portion on `threads` threads. `answers` has a block for each of the set's.
double trace_seconds(const Tracer& tracer, const Portion& portion, int threads, std::vector<AnswerBlock>& answers);

} // namespace duet::compare

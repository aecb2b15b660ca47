#include "compare/kernels/interleave.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

MedianRange median_range(std::vector<double> values) {
    DUET_CHECK(!values.empty());
    std::sort(values.begin(), values.end());
    return {values.front(), values[(values.size() - 1) / 2], values.back()};
}

namespace {

struct TimingPair {
    double ours, theirs;
    double ratio() const { return theirs / ours; }
};

PairedTiming median_pair(std::vector<TimingPair> pairs) {
    std::ranges::sort(pairs, {}, &TimingPair::ratio);
    const TimingPair& middle = pairs[(pairs.size() - 1) / 2];
    return {{pairs.front().ratio(), middle.ratio(), pairs.back().ratio()}, middle.ours, middle.theirs};
}

} // namespace

InterleavedTimings interleave(const TimedWork& ours, const std::vector<TimedWork>& peers, int repeats,
                              double time_limit, const Control& control) {
    std::vector<double> our_seconds;
    std::vector<std::vector<TimingPair>> pairs(peers.size());
    const Stopwatch watch;
    int round = 0;
    for (; round < repeats && (round < kMinRepeatsForVerdict || watch.seconds() < time_limit) && !control.stopped();
         ++round) {
        our_seconds.push_back(ours());
        for (std::size_t first = 0; first < peers.size() && !control.stopped(); first += 2) {
            pairs[first].push_back({our_seconds.back(), peers[first]()});
            if (first + 1 == peers.size()) break;
            const double theirs = peers[first + 1]();
            our_seconds.push_back(ours());
            pairs[first + 1].push_back({our_seconds.back(), theirs});
        }
        control.report(static_cast<double>(round + 1) / repeats);
    }
    InterleavedTimings result;
    if (control.stopped()) return result;
    result.seconds = median_range(our_seconds).median;
    result.repeats = round;
    for (const std::vector<TimingPair>& of_peer : pairs) result.peers.push_back(median_pair(of_peer));
    return result;
}

RaySubset choose_ray_subset(std::size_t rays, double rate, double seconds) {
    const std::size_t blocks = block_count(rays), groups = (blocks + RaySubset::kGroup - 1) / RaySubset::kGroup;
    const double wanted = rate * seconds / static_cast<double>(kBlock * RaySubset::kGroup); // groups to trace
    RaySubset subset;
    if (groups == 0) return subset;
    const double whole = static_cast<double>(groups);
    const auto count = static_cast<std::size_t>(clamp(std::ceil(wanted), 1.0, whole));
    subset.passes = static_cast<int>(clamp(std::round(wanted / whole), 1.0, 1e4));
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t group = i * groups / count;
        subset.groups.push_back(group);
        const std::size_t first = group * RaySubset::kGroup * kBlock;
        subset.rays += std::min(rays - first, RaySubset::kGroup * kBlock);
    }
    subset.rays *= static_cast<std::size_t>(subset.passes);
    return subset;
}

double trace_seconds(const Tracer& tracer, const RaySubset& subset, int threads,
                     std::vector<RayResultBlock>& ray_results) {
    const WorkStopwatch watch = work_stopwatch(threads);
    for (int pass = 0; pass < subset.passes; ++pass)
        parallel_for(subset.groups.size(), threads, [&](std::size_t i) {
            const std::size_t first = subset.groups[i] * RaySubset::kGroup;
            for (std::size_t block = first; block < std::min(first + RaySubset::kGroup, ray_results.size()); ++block)
                tracer.trace(block, ray_results[block].ray_results.data());
        });
    return watch.seconds();
}

} // namespace duet::compare

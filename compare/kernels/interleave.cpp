#include "compare/kernels/interleave.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

Range range_of(std::vector<double> values) {
    DUET_CHECK(!values.empty());
    std::sort(values.begin(), values.end());
    return {values.front(), values[(values.size() - 1) / 2], values.back()};
}

namespace {

struct Pair {
    double ours, theirs;
    double ratio() const { return theirs / ours; }
};

Versus versus(std::vector<Pair> pairs) {
    std::ranges::sort(pairs, {}, &Pair::ratio);
    const Pair& middle = pairs[(pairs.size() - 1) / 2];
    return {{pairs.front().ratio(), middle.ratio(), pairs.back().ratio()}, middle.ours, middle.theirs};
}

} // namespace

Interleaved interleave(const Timed& ours, const std::vector<Timed>& peers, int repeats, double time_limit,
                       const Control& control) {
    std::vector<double> our_seconds;
    std::vector<std::vector<Pair>> pairs(peers.size());
    const Stopwatch watch;
    int round = 0;
    for (; round < repeats && (round < kLeastForVerdict || watch.seconds() < time_limit) && !control.stopped();
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
    Interleaved result;
    if (control.stopped()) return result;
    result.seconds = range_of(our_seconds).median;
    result.repeats = round;
    for (const std::vector<Pair>& of_peer : pairs) result.peers.push_back(versus(of_peer));
    return result;
}

Portion portion_of(std::size_t rays, double rate, double seconds) {
    const std::size_t blocks = block_count(rays), groups = (blocks + Portion::kGroup - 1) / Portion::kGroup;
    const double wanted = rate * seconds / static_cast<double>(kBlock * Portion::kGroup); // groups to trace
    Portion portion;
    if (groups == 0) return portion;
    const double whole = static_cast<double>(groups);
    const auto count = static_cast<std::size_t>(clamp(std::ceil(wanted), 1.0, whole));
    portion.passes = static_cast<int>(clamp(std::round(wanted / whole), 1.0, 1e4));
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t group = i * groups / count;
        portion.groups.push_back(group);
        const std::size_t first = group * Portion::kGroup * kBlock;
        portion.rays += std::min(rays - first, Portion::kGroup * kBlock);
    }
    portion.rays *= static_cast<std::size_t>(portion.passes);
    return portion;
}

double trace_seconds(const Tracer& tracer, const Portion& portion, int threads, std::vector<AnswerBlock>& answers) {
    const WorkWatch watch(threads);
    for (int pass = 0; pass < portion.passes; ++pass)
        parallel_for(portion.groups.size(), threads, [&](std::size_t i) {
            const std::size_t first = portion.groups[i] * Portion::kGroup;
            for (std::size_t block = first; block < std::min(first + Portion::kGroup, answers.size()); ++block)
                tracer.trace(block, answers[block].answers.data());
        });
    return watch.seconds();
}

} // namespace duet::compare

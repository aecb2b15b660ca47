#include "compare/stress/trials.h"

#include "common/sampling/warp.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <mutex>

namespace duet::compare {

Vec2 TrialRandom::uniform_2d() {
    const float x = uniform();
    return {x, uniform()};
}

float TrialRandom::log_uniform(float low, float high) {
    return std::exp2(lerp(std::log2(low), std::log2(high), uniform()));
}

Vec3 TrialRandom::vector() {
    const float x = uniform(-1, 1), y = uniform(-1, 1);
    return {x, y, uniform(-1, 1)};
}

Vec3 TrialRandom::direction() { return uniform_sphere(uniform_2d()); }

namespace {

/// Returns the FNV-1a hash of a name (Fowler, Noll and Vo). Unlike std::hash it is the same on every platform.
std::uint64_t hash_name(std::string_view name) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return hash;
}

/// Adds a trial's errors unless it judged nothing.
void add(StressResult& result, const StressTest& test, const Trial& trial) {
    if (!trial.library_error()) return;
    ++result.trials;
    result.library.add(trial.number(), *trial.library_error(), test.bound);
    if (result.naive && trial.naive_error()) result.naive->add(trial.number(), *trial.naive_error(), test.bound);
}

/// Reports the completed fraction of a test. Calls do not overlap, and the fraction never decreases.
class SharedProgress {
public:
    SharedProgress(const Control& control, std::size_t parts) : control_(control), parts_(parts) {}
    void part_done() {
        const std::lock_guard lock(mutex_);
        control_.report(static_cast<double>(++done_) / static_cast<double>(parts_));
    }

private:
    const Control& control_;
    std::size_t parts_, done_ = 0;
    std::mutex mutex_;
};

/// Returns the number of trials that must judge something: the required fraction, less five standard deviations for
/// random variation.
std::int64_t least_trials(std::int64_t count, double required_fraction) {
    const double n = static_cast<double>(count), spread = std::sqrt(n * required_fraction * (1 - required_fraction));
    return std::max<std::int64_t>(1, std::llround(std::floor(n * required_fraction - 5 * spread)));
}

} // namespace

StressResult run_trials(const StressTest& test, const StressSetting& setting, const std::function<void(Trial&)>& body) {
    const std::int64_t count = setting.trials(test.trials);
    const std::uint64_t state = hash_combine(setting.seed, hash_name(test.name));
    const auto run = [&](std::int64_t number, bool collects_notes) {
        Trial trial(hash_combine(state, static_cast<std::uint64_t>(number)), number, count, collects_notes);
        body(trial);
        return trial;
    };

    // Chunks are small enough for load balancing, down to single costly trials, and large enough to make scheduling
    // overhead negligible.
    const std::int64_t part = std::clamp<std::int64_t>(count / 512, 1, 4096);
    std::vector<StressResult> parts(static_cast<std::size_t>((count + part - 1) / part));
    SharedProgress progress(setting.control, parts.size());
    parallel_for(parts.size(), setting.threads, [&](std::size_t i) {
        if (setting.control.stopped()) return;
        StressResult result;
        if (!test.naive.empty()) result.naive.emplace();
        const std::int64_t first = static_cast<std::int64_t>(i) * part, end = std::min(first + part, count);
        for (std::int64_t number = first; number < end; ++number) add(result, test, run(number, false));
        parts[i] = result;
        progress.part_done();
    });

    StressResult all;
    all.least_trials = least_trials(count, test.required_fraction);
    if (!test.naive.empty()) all.naive.emplace();
    for (const StressResult& result : parts) {
        all.trials += result.trials;
        all.library += result.library;
        if (all.naive && result.naive) *all.naive += *result.naive;
    }
    if (all.library.first_failure >= 0) all.details = run(all.library.first_failure, true).details();
    return all;
}

std::string exact(float x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", static_cast<double>(x));
    return text;
}
std::string exact(Vec3 v) { return message('(', exact(v.x), ", ", exact(v.y), ", ", exact(v.z), ')'); }

} // namespace duet::compare

// This header declares trials of one test that run in parallel. A trial's random numbers depend only on seed, test
// and trial.
#pragma once

#include "common/sampling/hash.h"
#include "common/system/error.h"
#include "common/vec/vec.h"
#include "compare/stress/stress.h"

#include <functional>

namespace duet::compare {

/// A TrialRandom is a trial's own random number stream.
class TrialRandom {
public:
    explicit TrialRandom(std::uint64_t state) : state_(state) {}

    std::uint64_t bits() { return stream_number(state_, index_++); }
    /// Returns a uniform value in [0, 1), a multiple of 2^-24 like the samplers' values.
    float uniform() { return unit_float(high_bits(bits())); }
    float uniform(float low, float high) { return low + (high - low) * uniform(); }
    /// Returns two uniform values in [0, 1).
    Vec2 uniform_2d();
    /// Returns a log-uniform value in [low, high]; both must be positive.
    float log_uniform(float low, float high);
    /// Returns a uniform integer in 0 … n − 1.
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>((bits() >> 32) * n >> 32); }
    bool coin() { return (bits() >> 63) != 0; }
    float sign() { return coin() ? 1.0f : -1.0f; }
    /// Returns a vector with each component uniform in [−1, 1).
    Vec3 vector();
    /// Returns a uniform direction, of unit length up to the rounding of its components.
    Vec3 direction();

private:
    std::uint64_t state_, index_ = 0;
};

/// A trial has a random number stream and collects the results.
class Trial {
public:
    Trial(std::uint64_t state, std::int64_t number, std::int64_t count, bool collects_notes)
        : random(state), number_(number), count_(count), collects_notes_(collects_notes) {}

    TrialRandom random;

    std::int64_t number() const { return number_; } ///< 0 … count() − 1, for tests that cycle through cases
    std::int64_t count() const { return count_; } ///< number of trials of the test
    /// Reports an error of the library's or of the textbook implementation. The largest of several errors counts,
    /// with NaN as the largest. A trial without an error of the library's implementation judged nothing and is not
    /// counted.
    void record(double error) { report(library_error_, error); }
    void record_naive(double error) { report(naive_, error); }
    /// Reports a trial that either holds or fails.
    void record_failure_if(bool wrong) { record(wrong ? 1 : 0); }
    void record_naive_failure_if(bool wrong) { record_naive(wrong ? 1 : 0); }

    /// Appends to the message that explains the trial. The message is used only after a failure, when the trial runs
    /// again to collect it.
    template <typename... Parts> void note(const Parts&... parts) {
        if (collects_notes_) details_ += (details_.empty() ? "" : "; ") + message(parts...);
    }

    const std::optional<double>& library_error() const { return library_error_; }
    const std::optional<double>& naive_error() const { return naive_; }
    const std::string& details() const { return details_; }

private:
    static void report(std::optional<double>& worst, double error) {
        if (!worst || error > *worst || std::isnan(error)) worst = error;
    }

    std::optional<double> library_error_, naive_;
    std::int64_t number_, count_;
    bool collects_notes_;
    std::string details_;
};

/// Runs `body` for each trial of the test on setting.threads threads and accumulates the results. The body may read
/// shared data, but must only write to its trial.
StressResult run_trials(const StressTest& test, const StressSetting& setting, const std::function<void(Trial&)>& body);
/// Calls run_trials() with `body`, which makes and judges one trial. StressTest::run may point to this function.
template <void (*body)(Trial&)> StressResult trials_of(const StressTest& test, const StressSetting& setting) {
    return run_trials(test, setting, body);
}

/// Returns the value with all digits, such as "(1, 2, 3)", for notes.
std::string exact(Vec3 v);
std::string exact(float x);

} // namespace duet::compare

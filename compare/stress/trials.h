// Many trials of one test, in parallel: the numbers a trial draws depend on seed, test and trial alone.
#pragma once

#include "common/sampling/hash.h"
#include "common/system/error.h"
#include "common/vec/vec.h"
#include "compare/stress/stress.h"

#include <functional>

namespace duet::compare {

/// A trial's random numbers: a stream of its own.
class TrialRandom {
public:
    explicit TrialRandom(std::uint64_t state) : state_(state) {}

    std::uint64_t bits() { return stream_number(state_, index_++); }
    /// Uniform in [0, 1): a multiple of 2^-24, as the samplers' numbers are.
    float uniform() { return unit_float(high_bits(bits())); }
    float uniform(float low, float high) { return low + (high - low) * uniform(); }
    Vec2 uniform_2d();
    /// 10 to a uniform power: every order of magnitude from `low` to `high` alike; both positive.
    float magnitude(float low, float high);
    /// 0 … n − 1.
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>((bits() >> 32) * n >> 32); }
    bool coin() { return (bits() >> 63) != 0; }
    float sign() { return coin() ? 1.0f : -1.0f; }
    /// Each component uniform in [−1, 1).
    Vec3 vector();
    /// Uniform over the unit sphere; of unit length up to the rounding of its components.
    Vec3 direction();

private:
    std::uint64_t state_, index_ = 0;
};

/// One trial: what it draws from, and where it reports.
class Trial {
public:
    Trial(std::uint64_t state, std::int64_t number, std::int64_t count, bool noting)
        : random(state), number_(number), count_(count), noting_(noting) {}

    TrialRandom random;

    std::int64_t number() const { return number_; } ///< 0 … count() − 1: for tests that go through cases in turn
    std::int64_t count() const { return count_; }   ///< of all trials of the test
    /// An error of the library's way, or of the books' way. The largest of several counts, NaN above all. A trial that
    /// reports no error of the library's way judged nothing, and is not counted.
    void careful(double error) { report(careful_, error); }
    void naive(double error) { report(naive_, error); }
    /// For trials that simply hold or not.
    void careful_wrong(bool wrong) { careful(wrong ? 1 : 0); }
    void naive_wrong(bool wrong) { naive(wrong ? 1 : 0); }

    /// Parts of a message that explains the trial. Only read where it has failed: it is then run once more for this.
    template <typename... Parts> void note(const Parts&... parts) {
        if (noting_) account_ += (account_.empty() ? "" : "; ") + message(parts...);
    }

    const std::optional<double>& careful_error() const { return careful_; }
    const std::optional<double>& naive_error() const { return naive_; }
    const std::string& account() const { return account_; }

private:
    static void report(std::optional<double>& worst, double error) {
        if (!worst || error > *worst || std::isnan(error)) worst = error;
    }

    std::optional<double> careful_, naive_;
    std::int64_t number_, count_;
    bool noting_;
    std::string account_;
};

/// Runs body for each trial of the test, on setting.threads threads, and adds up. The body may read what it shares with
/// others, and writes to its trial alone.
StressResult run_trials(const StressTest& test, const StressSetting& setting, const std::function<void(Trial&)>& body);

/// "(1, 2, 3)" with all digits, for notes.
std::string exact(Vec3 v);
std::string exact(float x);

} // namespace duet::compare

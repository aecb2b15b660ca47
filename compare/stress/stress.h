// The numerical stability suite: what a test of it is, and what it reports.
#pragma once

#include "common/system/control.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace duet::compare {

/// What a test is given. The same seed and factor give the same row, for any number of threads.
struct StressSetting {
    std::uint64_t seed = 0;
    double factor = 1; ///< of the default number of trials, > 0
    int threads = 0;   ///< 0: all
    Control control;   ///< of the test at hand; where it is stopped, its result means nothing

    /// A test's number of trials, at least 1.
    std::int64_t trials(std::int64_t by_default) const;
};

/// How one way of computing fared: a trial fails where its error is above the test's bound, or is NaN.
struct StressOutcome {
    std::int64_t failures = 0;
    double worst = 0;                ///< largest error, in the unit of the bound; NaN is worse than all
    std::int64_t first_failure = -1; ///< the lowest number of a trial that failed; −1: none did

    void add(std::int64_t trial, double error, double bound);
    StressOutcome& operator+=(const StressOutcome& other); ///< in any order the same
};

struct StressResult {
    std::int64_t trials = 0;            ///< those that judged something …
    std::int64_t least_trials = 1;      ///< … and how many had to (StressTest::judged)
    StressOutcome careful;              ///< the library's way: any failure fails the suite
    std::optional<StressOutcome> naive; ///< the books' way on the same trials: shows what care buys
    std::string account;                ///< what the first failed trial of the careful way noted of itself

    /// Whether the row is red: a trial failed, or too few judged anything.
    bool failed() const { return careful.failures > 0 || trials < least_trials; }
};

/// One row of the suite.
struct StressTest {
    std::string_view name;   ///< "intersection/leak-edges": a group and a test, both in lower case with hyphens
    std::string_view what;   ///< a sentence: what must hold, for which inputs
    double bound;            ///< of a trial's error; 0 where a trial simply holds (error 0) or not (error 1)
    std::string_view unit;   ///< of error and bound: "ulp", "relative", "wrong" …
    std::string_view source; ///< where the bound comes from: a paper, a derivation in a few words, an exact oracle
    std::string_view naive;  ///< what the naive column is: "t > 0.001, as the books have it"; empty: there is none
    std::int64_t trials;     ///< by default
    /// Usually run_trials (compare/stress/trials.h) with a function that makes and judges one trial.
    StressResult (*run)(const StressTest& test, const StressSetting& setting);
    /// The share of the trials that must judge something: others met a case that the row does not speak of. What always
    /// refuses to answer must not pass.
    double judged = 0.99;
};

// The groups, each in a file of its own (compare/stress/*_tests.cpp).
std::span<const StressTest> arithmetic_tests();   ///< robust arithmetic, frames, film sums
std::span<const StressTest> leak_tests();         ///< closed surfaces let no ray through
std::span<const StressTest> intersection_tests(); ///< spheres, slivers, degenerate triangles and rays, ties
std::span<const StressTest> departure_tests();    ///< leaving a surface: self-hits, parallel surfaces, instances
std::span<const StressTest> material_tests();     ///< refraction, furnaces, chi-squared, reciprocity
std::span<const StressTest> light_tests();        ///< solid angles, samples and densities of lights
std::span<const StressTest> coverage_tests();     ///< edges covered once, exact integers, guard band
std::span<const StressTest> projection_tests();   ///< near plane, attributes, derivatives, depth order
std::span<const StressTest> pipeline_tests();     ///< thread counts, both pipelines' Hits

/// All groups' tests in the order above.
std::vector<StressTest> all_stress_tests();
/// Those of the given names, or, of a name that no test has, those that begin with it up to a '/' or '-': "departure",
/// "intersection/leak". All where no names are given. Throws Error listing the tests where a name fits none.
std::vector<StressTest> select_stress_tests(const std::vector<std::string>& names);

} // namespace duet::compare

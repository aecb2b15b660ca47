// This header declares the tests and the results of the numerical stability suite.
#pragma once

#include "common/system/control.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace duet::compare {

/// Holds the settings of a test. The same seed and factor give the same result for any number of threads.
struct StressSetting {
    std::uint64_t seed = 0;
    double factor = 1; ///< multiplies the default number of trials, > 0
    int threads = 0;   ///< 0: all
    Control control; ///< of the current test; if it is stopped, its result is invalid

    /// Returns a test's number of trials, at least 1.
    std::int64_t trials(std::int64_t by_default) const;
};

/// Counts the failures of one implementation. A trial fails if its error is above the test's bound or NaN.
struct StressOutcome {
    std::int64_t failures = 0;
    double worst = 0; ///< largest error, in the unit of the bound; NaN is the worst
    std::int64_t first_failure = -1; ///< lowest number of a failed trial; −1: none failed

    /// Counts a trial, which fails if its error is above the bound or NaN.
    void add(std::int64_t trial, double error, double bound);
    StressOutcome& operator+=(const StressOutcome& other); ///< commutative
};

/// Holds the result of one test.
struct StressResult {
    std::int64_t trials = 0; ///< trials that judged something
    std::int64_t least_trials = 1;      ///< least number of trials that must judge (StressTest::required_fraction)
    StressOutcome library;              ///< the library's implementation: any failure fails the suite
    std::optional<StressOutcome> naive; ///< the textbook implementation on the same trials, for comparison
    std::string details;                ///< notes of the first failed trial of the library's implementation

    /// Returns whether the test failed: a trial failed, or too few trials judged anything.
    bool failed() const { return library.failures > 0 || trials < least_trials; }
};

/// This is one row of the suite.
struct StressTest {
    std::string_view name;   ///< "intersection/leak-edges": a group and a test, both in lower case with hyphens
    std::string_view what; ///< a sentence: what must hold, for which inputs
    double bound; ///< of a trial's error; 0 for a trial that either holds (error 0) or fails (error 1)
    std::string_view unit;   ///< of error and bound: "ulp", "relative", "wrong" …
    std::string_view source; ///< source of the bound: a paper, a short derivation, or an exact oracle
    std::string_view naive; ///< description of the naive column, such as "t > 0.001, as the books have it"; empty: none
    std::int64_t trials; ///< default number
    /// Runs the test, usually by run_trials (compare/stress/trials.h) with a function that makes and judges one
    /// trial.
    StressResult (*run)(const StressTest& test, const StressSetting& setting);
    /// This fraction of the trials must judge something; the others meet a case that the row does not cover. It
    /// prevents an implementation that never answers from passing.
    double required_fraction = 0.99;
};

// Each group of tests has its own file (*_tests.cpp).
std::span<const StressTest> arithmetic_tests();   ///< robust arithmetic, frames, film sums
std::span<const StressTest> leak_tests(); ///< closed surfaces are watertight
std::span<const StressTest> intersection_tests(); ///< spheres, slivers, degenerate triangles and rays, ties
std::span<const StressTest> ray_origin_tests();   ///< leaving a surface: self-hits, parallel surfaces, instances
std::span<const StressTest> material_tests();     ///< refraction, furnaces, chi-squared, reciprocity
std::span<const StressTest> light_tests();        ///< solid angles, samples and densities of lights
std::span<const StressTest> medium_tests();       ///< columns of clouds, weights of collisions and walks
std::span<const StressTest> coverage_tests();     ///< edges covered once, exact integers, guard band
std::span<const StressTest> projection_tests();   ///< near plane, attributes, derivatives, depth order
std::span<const StressTest> pipeline_tests();     ///< thread counts, both pipelines' Hits
std::span<const StressTest> scene_tests();        ///< random valid scenes

/// Returns the tests of all groups in the order of the functions above.
std::vector<StressTest> all_stress_tests();
/// Returns the tests of the given names. A name that matches no test selects those that begin with it up to a '/' or
/// '-', such as "departure" or "intersection/leak". Without names, all tests are returned. Throws Error, listing the
/// groups, if a name matches none.
std::vector<StressTest> select_stress_tests(const std::vector<std::string>& names);

} // namespace duet::compare

// This header declares `compare stress`, which runs the numerical stability suite.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds the options of `compare stress`.
struct StressOptions {
    double factor = 1; ///< multiplies the default number of trials, > 0
    std::vector<std::string> only; ///< names of tests or their beginnings; empty: all
    bool list = false; ///< list the tests instead of running them
    std::uint64_t seed = 0;
    int threads = 0;   ///< 0: all
    std::string stats; ///< output file for the rows as JSON; "-": standard output; empty: none
    bool quiet = false;
};

/// Prints one row per test as it finishes. Returns 1 if a test failed, 130 after a signal, else 0. Throws Error for
/// invalid names and files.
int stress(const StressOptions& options);

} // namespace duet::compare

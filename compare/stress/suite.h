// `compare stress`: runs the numerical stability suite.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace duet::compare {

struct StressOptions {
    double factor = 1;             ///< times the default number of trials, > 0
    std::vector<std::string> only; ///< tests or beginnings of their names; empty: all
    bool list = false;             ///< say what the tests are, and run none
    std::uint64_t seed = 0;
    int threads = 0;   ///< 0: all
    std::string stats; ///< a file for the rows as JSON, "-" for standard output, empty: none
    bool quiet = false;
    std::string sabotage; ///< a guard to do without, in a sabotage build; empty: none
};

/// Prints a row a test as it is done. Returns 1 where a test failed, 130 where a signal came, else 0. Throws Error for
/// names and files that cannot be used.
int stress(const StressOptions& options);

} // namespace duet::compare

// Subcommands of the program `compare`. Each one's command-line arguments are defined next to the code they configure.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace duet::compare {

/// A subcommand: its command-line arguments and the function to call if it was given.
struct Subcommand {
    CLI::App* arguments;
    std::function<int()> run; ///< returns the exit code
};

Subcommand add_run(CLI::App& app);
Subcommand add_ladder(CLI::App& app);
Subcommand add_images(CLI::App& app);
Subcommand add_skip(CLI::App& app);
Subcommand add_bench(CLI::App& app);
Subcommand add_stop(CLI::App& app);
Subcommand add_kernels(CLI::App& app);
Subcommand add_frames(CLI::App& app);
Subcommand add_stress(CLI::App& app);

/// Text appended to each subcommand's --help.
inline constexpr const char* kExitCodes =
    "\n\nExit codes: 0 done, 1 failed (a metric over its limit, a failed test, a result that could not be written), 2 "
    "unusable arguments or input, 130 interrupted (nothing is written).";

} // namespace duet::compare

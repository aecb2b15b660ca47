// This file declares the subcommands of the program `compare`. The command-line arguments of each are defined next to
// the code that they configure.
#pragma once

#include "common/program/command_line.h"

#include <memory>
#include <string>

namespace duet::compare {

/// Adds the subcommand of this name, with its options.
///@{
void add_run(CommandLine& program);
void add_ladder(CommandLine& program);
void add_images(CommandLine& program);
void add_join(CommandLine& program);
void add_skip(CommandLine& program);
void add_bench(CommandLine& program);
void add_stop(CommandLine& program);
void add_kernels(CommandLine& program);
void add_frames(CommandLine& program);
void add_stress(CommandLine& program);
void add_check(CommandLine& program);
void add_view(CommandLine& program);
///@}

struct ComparisonSettings; // compare/renderer.h
/// Adds --depth and --threads.
void add_depth_and_threads(CommandLine& subcommand, ComparisonSettings& settings);

/// Sets the function that a subcommand runs. Returns its options, which the parser fills in.
template <typename Options> Options& set_action(CommandLine& subcommand, int (*action)(const Options&)) {
    const auto options = std::make_shared<Options>();
    subcommand.set_action([options, action] { return action(*options); });
    return *options;
}

/// Sets the text below the options in a subcommand's --help, and explains the exit codes there.
inline void set_footer(CommandLine& subcommand, const std::string& text) {
    subcommand.set_footer(
        text + "\n\nExit codes: 0 done, 1 failed (a metric over its limit, a failed test, a result that could not be "
               "written), 2 unusable arguments or input, 130 interrupted (nothing is written).");
}

} // namespace duet::compare

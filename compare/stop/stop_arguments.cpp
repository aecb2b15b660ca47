// Command-line arguments of `compare stop`.
#include "common/program/option_checks.h"
#include "compare/arguments.h"
#include "compare/stop/stop.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace duet::compare {

Subcommand add_stop(CLI::App& app) {
    CLI::App* stop = app.add_subcommand(
        "stop", "Whether `raytrace --error` and `--time` end where they are told to, and what adaptive sampling is "
                "worth");
    const auto all = std::make_shared<StopOptions>();
    const auto size = std::make_shared<std::string>();
    StopOptions& options = *all;
    stop->add_option("SCENE", options.scenes, "Scene files (.json) or bare meshes (.obj)")->required();
    stop->add_option("--error", options.settings.error, "The relMSE to ask for (default 0.001)")
        ->check(positive_number());
    stop->add_option("--time", options.settings.time, "Also ask for renders of so many seconds")
        ->check(positive_number());
    stop->add_option("--seeds", options.settings.seeds, "Renders, each of a seed of its own (default 20)")
        ->check(CLI::Range(1, 10000));
    stop->add_option("--size", *size,
                     "Image size WIDTHxHEIGHT (default: the scene's shape, its longer side 96 pixels)");
    stop->add_option("--reference-spp", options.reference_spp, "The reference's samples a pixel (default 4096)")
        ->check(CLI::Range(2, 1 << 24));
    stop->add_option(
        "--references", options.references,
        "The folder where references are kept (default: duet/references below $XDG_CACHE_HOME or ~/.cache)");
    stop->add_option("--threads", options.settings.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    stop->add_option("--stats", options.stats, "Write the figures as JSON to this file (-: standard output)");
    stop->add_flag("--quiet", options.quiet, "No table, no progress bar");
    stop->footer(
        std::string(
            "Example:\n  compare stop models/cornell.json models/demo.json --error 0.002\n\n"
            "A row a scene: the median error of all seeds over the one requested, which is to be within 20 %; "
            "adaptive over even sampling, by squared error × time, below 1 where adaptive sampling pays; and the "
            "time farthest from the one requested, which is to be within 5 % or one pass of two samples a pixel. A "
            "scene "
            "with mirrors or glass and lights has caustics, and its error is reported only.") +
        kExitCodes);
    return {stop, [all, size] {
                if (!size->empty()) all->size = parse_image_size(*size);
                return compare::stop(*all);
            }};
}

} // namespace duet::compare

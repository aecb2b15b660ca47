// This file declares the command-line arguments of `compare stop`.
#include "compare/arguments.h"
#include "compare/stop/stop.h"

namespace duet::compare {

void add_stop(CommandLine& program) {
    CommandLine& stop = program.add_subcommand(
        "stop", "Whether `raytrace --error` and `--time` end where they are told to, and what adaptive sampling is "
                "worth");
    StopOptions& options = set_action(stop, compare::stop);
    stop.add("SCENE", options.scenes, "Scene files (.json) or bare meshes (.obj)").required();
    stop.add("--error", options.settings.error, "The relMSE to ask for (default 0.001)").positive();
    stop.add("--time", options.settings.time, "Also ask for renders of so many seconds").positive();
    stop.add("--seeds", options.settings.seeds, "Renders, each of a seed of its own (default 20)").range(1, 10000);
    stop.add("--size", options.size, "Image size WIDTHxHEIGHT (default: the scene's shape, its longer side 96 pixels)");
    stop.add("--reference-spp", options.reference_spp, "The reference's samples per pixel (default 4096)")
        .range(2, 1 << 24);
    stop.add("--references", options.references,
             "The folder where references are kept (default: duet/references below $XDG_CACHE_HOME or ~/.cache)");
    stop.add("--threads", options.settings.threads, "Threads (default: all)").range(1, 1024);
    stop.add("--stats", options.stats, "Write the figures as JSON to this file (-: standard output)");
    stop.add_flag("--quiet", options.quiet, "No table, no progress bar");
    set_footer(stop,
               "Example:\n  compare stop models/cornell.json models/demo.json --error 0.002\n\n"
               "A row a scene: the median error of all seeds over the one requested, which is to be within 20 %; "
               "adaptive over even sampling, by squared error × time, below 1 where adaptive sampling pays; and the "
               "time farthest from the one requested, which is to be within 5 % or one pass of two samples per pixel. "
               "A scene with mirrors or glass and lights has caustics, and its error is reported only.");
}

} // namespace duet::compare

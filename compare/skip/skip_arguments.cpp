// This file declares the command-line arguments of `compare skip`.
#include "common/program/command_line.h"
#include "compare/arguments.h"
#include "compare/skip/skip.h"

namespace duet::compare {

void add_skip(CommandLine& program) {
    CommandLine& skip = program.add_subcommand(
        "skip",
        "Switch each skip of both pipelines off in turn: the time it saves, and proof that the image is the same");
    SkipOptions& options = set_action(skip, compare::skip);
    skip.add("SCENE", options.scene, "A scene file (.json) or a bare mesh (.obj)").required();
    skip.add("--size", options.size,
             "Image size WIDTHxHEIGHT (default: the scene's shape, its longer side 128 pixels)");
    skip.add("--spp", options.settings.raytrace_spp, "The path tracer's samples per pixel (default 4)")
        .range(1, 1 << 20);
    skip.add("--raster-spp", options.settings.raster_spp, "The rasterizer's samples per pixel (default 4)")
        .range(1, 1 << 20);
    skip.add("--repeats", options.measure.repeats, "Images each way, in turns (default 5)").range(1, 10000);
    skip.add("--budget", options.measure.budget,
             "Seconds at most for each skip whose images differ in bits: they are rendered in pairs until a "
             "bias of 0.1 % would be found with 99 % power (default 120)")
        .number_range(0, 1e7, "a number from 0 to 1e7");
    skip.add("--only", options.only,
             "A skip by name (raster/back_faces, or lens for both pipelines'); may be given more than once")
        .repeatable();
    skip.add("--threads", options.settings.threads, "Threads (default: all)").range(1, 1024);
    skip.add("--seed", options.measure.seed, "The first seed; each repeat takes the next (default 0)");
    skip.add("--stats", options.stats, "Write the rows as JSON to this file (-: standard output)");
    skip.add_flag("--quiet", options.quiet, "No table, no progress bar");
    set_footer(skip, "Example:\n  compare skip models/cornell.json --only russian_roulette\n\n"
                     "A skip is proved where all images have the same bits with and without it, or where no "
                     "bias is found by a test that would find one of 0.1 %; else the exit code is 1.");
}

} // namespace duet::compare

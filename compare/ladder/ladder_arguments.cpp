// This file declares the command-line arguments of `compare ladder`.
#include "common/program/command_line.h"
#include "compare/arguments.h"
#include "compare/ladder/ladder.h"

namespace duet::compare {

void add_ladder(CommandLine& program) {
    CommandLine& ladder = program.add_subcommand(
        "ladder", "Both pipelines side by side, rung by rung, and where the difference of their images comes from");
    LadderOptions& options = set_action(ladder, compare::ladder);
    ComparisonSettings& settings = options.settings;
    ladder.add("SCENE", options.scene, "A scene file (.json) or a bare mesh (.obj)").required();
    ladder.add("-o,--output", options.folder, "The folder for index.html, report.json and the images").required();
    add_scene_options(ladder, options.scene_options);
    ladder
        .add("--spp", settings.raytrace_spp,
             "The path tracer's samples per pixel, in two halves (default 64; odd numbers are rounded up)")
        .range(1, 1 << 24);
    ladder.add("--raster-spp", settings.raster_spp, "The rasterizer's samples per pixel (default 16)")
        .range(1, 1 << 24);
    add_depth_and_threads(ladder, settings);
    ladder.add("--seed", settings.seed, "Seed of all random numbers (default 0)");
    ladder.add("--stats", options.stats, "Write the figures of report.json to this file too (-: standard output)");
    ladder.add_flag("--quiet", options.quiet, "No progress bar, no table");
    set_footer(ladder, "Example:\n  compare ladder models/cornell.json -o out --spp 256\n"
                       "then open out/index.html in a browser.");
}

} // namespace duet::compare

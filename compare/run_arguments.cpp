// This file declares the command-line arguments of `compare run`.
#include "common/program/command_line.h"
#include "compare/arguments.h"
#include "compare/run.h"

namespace duet::compare {

void add_run(CommandLine& program) {
    CommandLine& run = program.add_subcommand(
        "run", "Render a scene with the rasterizer and the path tracer, and report what differs");
    RunOptions& options = set_action(run, compare::run);
    ComparisonSettings& settings = options.settings;
    run.add("SCENE", options.scene, "A scene file (.json) or a bare mesh (.obj: framed, on a ground under a sky)")
        .required();
    run.add("-o,--output", options.folder,
            "The folder for index.html, raster.png, raytrace.png, difference.png and report.json")
        .required();
    add_scene_options(run, options.scene_options);
    run.add("--spp", settings.raytrace_spp, "The path tracer's samples per pixel (default 64)").range(1, 1 << 24);
    run.add("--raster-spp", settings.raster_spp, "The rasterizer's samples per pixel (default 16)").range(1, 1 << 24);
    add_depth_and_threads(run, settings);
    run.add("--seed", settings.seed, "Seed of all random numbers (default 0)");
    add_view_transform(run, options.view_transform);
    run.add("--stats", options.stats, "Write the figures of report.json to this file too (-: standard output)");
    run.add_flag("--quiet", options.quiet, "No progress bar, no summary");
    set_footer(run, "Example:\n  compare run models/cornell.json -o out --size 512x512 --spp 256\n"
                    "then open out/index.html in a browser.");
}

} // namespace duet::compare

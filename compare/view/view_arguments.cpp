// This file declares the command-line arguments of `compare view`.
#include "common/program/command_line.h"
#include "compare/arguments.h"
#include "compare/view/view.h"

namespace duet::compare {

void add_view(CommandLine& program) {
    CommandLine& view = program.add_subcommand(
        "view", "Open a window: the rasterizer and the path tracer side by side, live, and the scene to be edited");
    ViewOptions& options = set_action(view, compare::view);
    view.add("SCENE", options.scene, "A scene file (.json) or a bare mesh (.obj: framed, on a ground under a sky)")
        .required();
    add_scene_options(view, options.scene_options);
    view.add("--window", options.window, "Size of the window WIDTHxHEIGHT (default 1600x900)");
    view.add("-o,--output", options.folder, "The folder for screenshots and images (default: the current one)");
    view.add("--spp", options.settings.raytrace_spp, "The path tracer's samples per pixel at most (default 4096)")
        .range(1, 1 << 24);
    view.add("--raster-spp", options.settings.raster_spp, "The rasterizer's samples per pixel (default 1)")
        .range(1, 1 << 16);
    add_depth_and_threads(view, options.settings);
    add_view_transform(view, options.view_transform);
    view.add("--measure", options.measure,
             "Turn the camera once around in this many seconds, print how fast the window is, and close it")
        .positive();
    view.add("--stats", options.stats, "Write the figures of --measure to this file (-: standard output)")
        .needs("--measure");
    set_footer(
        view, "Mouse: drag orbits (Shift: pans, Ctrl: looks around), the wheel moves closer, a click selects, a double "
              "click looks there.\nKeys: ? lists them all.\n\nExample:\n  compare view models/cornell.json");
}

} // namespace duet::compare

// This file declares the arguments of `compare check`.
#include "compare/arguments.h"
#include "compare/check/check.h"

namespace duet::compare {

void add_check(CommandLine& program) {
    CommandLine& check = program.add_subcommand(
        "check", "Check that scenes render soundly both ways: explained hits, valid samples, the same bits for any "
                 "number of threads");
    CheckOptions& options = set_action(check, compare::check);
    check.add("SCENE", options.scenes, "Scene files (.json) or bare meshes (.obj); -: the names on standard input, "
                                       "one a line")
        .required();
    check.add("--size", options.size, "Image size WIDTHxHEIGHT (default: the scene's)");
    check.add("--spp", options.settings.raytrace_spp,
              "The path tracer's samples per pixel (default 4); at least 2, because their variance is checked")
        .range(2, 1 << 20);
    check.add("--raster-spp", options.settings.raster_spp, "The rasterizer's samples per pixel (default 1)")
        .range(1, 1 << 20);
    check.add("--seed", options.settings.seed, "Seed of all random numbers (default 0)");
    check.add("--memory", options.memory_limit, "Limit of the address space in MiB (default: none)")
        .range(256, 1 << 30);
    set_footer(check, "Prints one JSON object a line for each scene.\n\n"
                      "Example:\n  compare check models/*.json --size 64x48");
}

} // namespace duet::compare

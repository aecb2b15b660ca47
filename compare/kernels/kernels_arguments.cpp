// This file declares the command-line arguments of `compare kernels`.
#include "common/program/command_line.h"
#include "compare/arguments.h"
#include "compare/kernels/kernels.h"
#include "compare/kernels/measure_kernels.h"

namespace duet::compare {

void add_kernels(CommandLine& program) {
    CommandLine& kernels = program.add_subcommand(
        "kernels", "How fast rays are traced and hierarchies built, beside Embree on the same triangles and rays");
    KernelsOptions& options = set_action(kernels, compare::kernels);
    KernelSettings& settings = options.settings;
    kernels.add("MESH", options.meshes, "Bare meshes (.obj), or scene files (.json), which are measured as they are")
        .required();
    kernels
        .add("--scene", options.scenes,
             "How a bare mesh stands: alone (as framed), room (in a closed box), clutter (27 rotated copies in "
             "a closed box), instances (the same copies as instances of one mesh); default alone,room")
        .comma_separated();
    kernels
        .add("--work", settings.works,
             "Of build (seconds, and bytes a triangle), camera (single rays), camera-bulk (packets and streams), "
             "bounce, shadow (default: all)")
        .comma_separated();
    kernels
        .add("--peers", options.peers,
             "Embree's settings: medium, high (build quality), medium-robust, high-robust, where there is AVX-512 "
             "medium-avx2 and high-avx2, or none (default: all)")
        .comma_separated();
    kernels.add("--size", settings.size, "One camera ray a pixel of WIDTHxHEIGHT (default 1920x1080)");
    kernels.add("--threads", settings.threads, "Threads of the second set of rows, after one thread's (default: all)")
        .range(1, 1024);
    kernels
        .add("--repeats", settings.repeats, "Measurements of each, in turns; under 5 there is no verdict (default 7)")
        .range(1, 10000);
    kernels.add("--seconds", settings.seconds, "Length of one measurement of rays (default 0.15)")
        .number_range(1e-4, 1e4, "seconds from 1e-4 to 1e4");
    kernels
        .add("--watertight", settings.watertight,
             "Rays aimed at points, edges and vertices from within, each judged in double precision, where the mesh or "
             "room is closed; 0: none (default 1000000)")
        .range(std::int64_t{0}, std::int64_t{1} << 40);
    kernels.add("--seed", settings.seed, "Seed of all random numbers (default 0)");
    kernels.add("--stats", options.stats, "Write the rows as JSON to this file (-: standard output)");
    kernels.add_flag("--quiet", options.quiet, "No table, no progress bar; faults are still explained");
    set_footer(kernels, "Example:\n  compare kernels bunny.obj models/cornell.json --scene room,clutter --stats "
                        "kernels.json\n\nThe table sets ours against the best of the peer's settings, --stats "
                        "against each. A ratio above 1 is ours ahead. The exit code is 1 where one of our "
                        "answers is wrong by the double-precision judge, or a ray of ours slips through an edge "
                        "or leaks out of a closed room or mesh.");
}

} // namespace duet::compare

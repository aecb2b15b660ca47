// The main program of `compare`.

#include "common/program/program.h"
#include "common/program/render_program.h"
#include "compare/arguments.h"

#include <CLI/CLI.hpp>
#include <vector>

using namespace duet;
using namespace duet::compare;

int main(int argc, char** argv) {
    return run_program("compare", [&] {
        CLI::App app("One scene, two pipelines: renders it both ways and tells what differs, and what each way cost.",
                     "compare");
        app.require_subcommand(1);
        app.footer("Example:\n  compare run models/cornell.json -o out\n\n`compare SUBCOMMAND --help` explains each.");
        const std::vector<Subcommand> subcommands = {add_run(app),   add_ladder(app),  add_images(app), add_skip(app),
                                                     add_bench(app), add_stop(app), add_kernels(app), add_frames(app),
                                                     add_stress(app)};
        const ParsedCommandLine parsed = parse_command_line(app, argc, argv);
        if (!parsed.proceed) return parsed.exit_code;
        for (const Subcommand& subcommand : subcommands)
            if (subcommand.arguments->parsed()) return subcommand.run();
        return kExitUnusable; // not reached: one subcommand is required
    });
}

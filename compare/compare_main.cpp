// This file is the main program of `compare`.

#include "common/program/program.h"
#include "compare/arguments.h"

using namespace duet;
using namespace duet::compare;

int main(int argc, char** argv) {
    return run_program("compare", [&] {
        CommandLine program("compare",
                            "One scene, two pipelines: renders it both ways and tells what differs, and what each way "
                            "cost.");
        program.set_footer(
            "Example:\n  compare run models/cornell.json -o out\n\n`compare SUBCOMMAND --help` explains each.");
        for (const auto add :
             {add_run, add_ladder, add_images, add_join, add_skip, add_bench, add_stop, add_kernels, add_frames,
              add_stress, add_check, add_view})
            add(program);
        const std::optional<int> exit_code = program.parse(argc, argv);
        return exit_code ? *exit_code : program.run_subcommand();
    });
}

// This file declares the arguments of `compare stress`.
#include "compare/arguments.h"
#include "compare/stress/suite.h"

namespace duet::compare {

void add_stress(CommandLine& program) {
    CommandLine& stress = program.add_subcommand(
        "stress", "Test the numerics of both pipelines, and show what the books' way would have done");
    StressOptions& options = set_action(stress, compare::stress);
    stress.add("--trials", options.factor, "Times the default number of trials (default 1: about a minute)")
        .number_range(1e-6, 1e6, "a number from 1e-6 to 1e6");
    stress.add("--only", options.only,
               "A test, or how the names of some begin: intersection, departure/self-hits; may be given more "
               "than once");
    stress.add_flag("--list", options.list, "Say what each test is, its bound and the bound's source; run none");
    stress.add("--seed", options.seed, "Seed of all random numbers (default 0)");
    stress.add("--threads", options.threads, "Threads (default: all)").range(1, 1024);
    stress.add("--stats", options.stats, "Write the rows as JSON to this file (-: standard output)");
    stress.add_flag("--quiet", options.quiet, "No table, no progress bar; failures are still explained");
    set_footer(stress, "Example:\n  compare stress --only intersection --trials 10");
}

} // namespace duet::compare

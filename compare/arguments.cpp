#include "compare/arguments.h"

#include "compare/renderer.h"
#include "raytrace/settings.h"

namespace duet::compare {

void add_depth_and_threads(CommandLine& subcommand, ComparisonSettings& settings) {
    subcommand
        .add("--depth", settings.max_depth,
             "The path tracer's scattering events at most: 0 emission only, 1 direct light (default 64)")
        .range(0, raytrace::PathTracerSettings::kMostDepth);
    subcommand.add("--threads", settings.threads, "Threads (default: all)").range(1, 1024);
}

} // namespace duet::compare

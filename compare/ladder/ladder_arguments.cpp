// Command-line arguments of `compare ladder`.
#include "common/program/option_checks.h"
#include "common/program/render_program.h"
#include "compare/arguments.h"
#include "compare/ladder/ladder.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace duet::compare {

Subcommand add_ladder(CLI::App& app) {
    CLI::App* ladder = app.add_subcommand(
        "ladder", "Both pipelines side by side, rung by rung, and where the difference of their images comes from");
    const auto all = std::make_shared<LadderOptions>();
    const auto size = std::make_shared<std::string>();
    LadderOptions& options = *all;
    ComparisonSettings& settings = options.settings;
    ladder->add_option("SCENE", options.scene, "A scene file (.json) or a bare mesh (.obj)")->required();
    ladder->add_option("-o,--output", options.folder, "The folder for index.html, report.json and the images")
        ->required();
    ladder->add_option("--size", *size, "Image size WIDTHxHEIGHT (default: the scene's)");
    ladder
        ->add_option("--spp", settings.raytrace_spp,
                     "The path tracer's samples a pixel, in two halves (default 64; odd numbers are rounded up)")
        ->check(CLI::Range(1, 1 << 24));
    ladder->add_option("--raster-spp", settings.raster_spp, "The rasterizer's samples a pixel (default 16)")
        ->check(CLI::Range(1, 1 << 24));
    ladder
        ->add_option("--depth", settings.max_depth,
                     "The path tracer's scattering events at most: 0 emission only, 1 direct light (default 64)")
        ->check(CLI::Range(0, 1 << 20));
    ladder->add_option("--threads", settings.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    ladder->add_option("--seed", settings.seed, "Seed of all random numbers (default 0)")->check(unsigned_integer());
    ladder->add_option("--stats", options.stats,
                       "Write the figures of report.json to this file too (-: standard output)");
    ladder->add_flag("--quiet", options.quiet, "No progress bar, no table");
    ladder->footer(std::string("Example:\n  compare ladder models/cornell.json -o out --spp 256\n"
                               "then open out/index.html in a browser.") +
                   kExitCodes);
    return {ladder, [all, size] {
                if (!size->empty()) all->size = parse_image_size(*size);
                return compare::ladder(*all);
            }};
}

} // namespace duet::compare

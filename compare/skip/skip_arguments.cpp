// Command-line arguments of `compare skip`.
#include "common/program/option_checks.h"
#include "common/program/render_program.h"
#include "compare/arguments.h"
#include "compare/skip/skip.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace duet::compare {

Subcommand add_skip(CLI::App& app) {
    CLI::App* skip = app.add_subcommand(
        "skip",
        "Switch each skip of both pipelines off in turn: the time it saves, and proof that the image is the same");
    const auto all = std::make_shared<SkipOptions>();
    const auto size = std::make_shared<std::string>();
    SkipOptions& options = *all;
    skip->add_option("SCENE", options.scene, "A scene file (.json) or a bare mesh (.obj)")->required();
    skip->add_option("--size", *size,
                     "Image size WIDTHxHEIGHT (default: the scene's shape, its longer side 128 pixels)");
    skip->add_option("--spp", options.settings.raytrace_spp, "The path tracer's samples a pixel (default 4)")
        ->check(CLI::Range(1, 1 << 20));
    skip->add_option("--raster-spp", options.settings.raster_spp, "The rasterizer's samples a pixel (default 4)")
        ->check(CLI::Range(1, 1 << 20));
    skip->add_option("--repeats", options.measure.repeats, "Images each way, in turns (default 5)")
        ->check(CLI::Range(1, 10000));
    skip->add_option("--budget", options.measure.budget,
                     "Seconds at most for each skip whose images differ in bits: they are rendered in pairs until a "
                     "bias of 0.1 % would be found with 99 % power (default 120)")
        ->check(number_in_range(0, 1e7, "a number from 0 to 1e7"));
    skip->add_option("--only", options.only,
                     "A skip by name (raster/back_faces, or lens for both pipelines'); may be given more than once")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    skip->add_option("--threads", options.settings.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    skip->add_option("--seed", options.measure.seed, "The first seed; each repeat takes the next (default 0)")
        ->check(unsigned_integer());
    skip->add_option("--stats", options.stats, "Write the rows as JSON to this file (-: standard output)");
    skip->add_flag("--quiet", options.quiet, "No table, no progress bar");
    skip->footer(std::string("Example:\n  compare skip models/cornell.json --only russian_roulette\n\n"
                             "A skip is proved where all images have the same bits with and without it, or where no "
                             "bias is found by a test that would find one of 0.1 %; else the exit code is 1.") +
                 kExitCodes);
    return {skip, [all, size] {
                all->size = size->empty() ? ImageSize{0, 0} : parse_image_size(*size);
                return compare::skip(*all);
            }};
}

} // namespace duet::compare

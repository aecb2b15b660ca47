// Command-line arguments of `compare run`.
#include "common/program/option_checks.h"
#include "common/program/render_program.h"
#include "compare/arguments.h"
#include "compare/run.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace duet::compare {

Subcommand add_run(CLI::App& app) {
    CLI::App* run =
        app.add_subcommand("run", "Render a scene with the rasterizer and the path tracer, and report what differs");
    const auto all = std::make_shared<RunOptions>();
    const auto size = std::make_shared<std::string>();
    RunOptions& options = *all;
    ComparisonSettings& settings = options.settings;
    run->add_option("SCENE", options.scene,
                    "A scene file (.json) or a bare mesh (.obj: framed, on a ground under a sky)")
        ->required();
    run->add_option("-o,--output", options.folder,
                    "The folder for index.html, raster.png, raytrace.png, difference.png and report.json")
        ->required();
    run->add_option("--size", *size, "Image size WIDTHxHEIGHT (default: the scene's)");
    run->add_option("--spp", settings.raytrace_spp, "The path tracer's samples a pixel (default 64)")
        ->check(CLI::Range(1, 1 << 24));
    run->add_option("--raster-spp", settings.raster_spp, "The rasterizer's samples a pixel (default 16)")
        ->check(CLI::Range(1, 1 << 24));
    run->add_option("--depth", settings.max_depth,
                    "The path tracer's scattering events at most: 0 emission only, 1 direct light (default 64)")
        ->check(CLI::Range(0, 1 << 20));
    run->add_option("--threads", settings.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    run->add_option("--seed", settings.seed, "Seed of all random numbers (default 0)")->check(unsigned_integer());
    run->add_option("--stats", options.stats, "Write the figures of report.json to this file too (-: standard output)");
    run->add_flag("--quiet", options.quiet, "No progress bar, no summary");
    run->footer(std::string("Example:\n  compare run models/cornell.json -o out --size 512x512 --spp 256\n"
                            "then open out/index.html in a browser.") +
                kExitCodes);
    return {run, [all, size] {
                if (!size->empty()) all->size = parse_image_size(*size);
                return compare::run(*all);
            }};
}

} // namespace duet::compare

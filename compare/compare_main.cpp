// The program `compare`.

#include "common/program/program.h"
#include "compare/images.h"
#include "compare/run.h"

#include <CLI/CLI.hpp>

using namespace duet;

namespace {

constexpr const char* kExitCodes =
    "\n\nExit codes: 0 done, 1 failed (a metric over its limit, a result that could not be written), 2 unusable "
    "arguments or input, 130 interrupted (nothing is written).";

struct RunArguments {
    compare::RunOptions options;
    std::string size;
};

CLI::App* add_run(CLI::App& app, RunArguments& arguments) {
    CLI::App* run =
        app.add_subcommand("run", "Render a scene with the rasterizer and the path tracer, and report what differs");
    compare::RunOptions& options = arguments.options;
    compare::PipelineSettings& settings = options.settings;
    run->add_option("SCENE", options.scene,
                    "A scene file (.json) or a bare mesh (.obj: framed, on a ground under a sky)")
        ->required();
    run->add_option("-o,--output", options.folder,
                    "The folder for index.html, raster.png, raytrace.png, difference.png and report.json")
        ->required();
    run->add_option("--size", arguments.size, "Picture size WIDTHxHEIGHT (default: the scene's)");
    run->add_option("--spp", settings.raytrace_spp, "The path tracer's samples a pixel (default 64)")
        ->check(CLI::Range(1, 1 << 24));
    run->add_option("--raster-spp", settings.raster_spp, "The rasterizer's samples a pixel (default 16)")
        ->check(CLI::Range(1, 1 << 24));
    run->add_option("--depth", settings.max_depth,
                    "The path tracer's scattering events at most: 0 emission only, 1 direct light (default 64)")
        ->check(CLI::Range(0, 1 << 20));
    run->add_option("--threads", settings.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    run->add_option("--seed", settings.seed, "Seed of all random numbers (default 0)");
    run->add_option("--stats", options.stats, "Write the figures of report.json to this file too (-: standard output)");
    run->add_flag("--quiet", options.quiet, "No progress bar, no summary");
    run->footer(std::string("Example:\n  compare run models/cornell.json -o out --size 512x512 --spp 256\n"
                            "then open out/index.html in a browser.") +
                kExitCodes);
    return run;
}

CLI::App* add_images(CLI::App& app, compare::ImagesOptions& options) {
    CLI::App* images = app.add_subcommand("images", "Compare two picture files");
    images->add_option("A", options.a, "A picture (PNG, JPEG, TGA, PPM, PFM, HDR, EXR)")->required();
    images->add_option("B", options.reference, "The reference, of the same size")->required();
    images->add_option(
        "--fail-above", options.limits,
        "METRIC=VALUE: exit with 1 where mse, rmse, mae, relmse or worst is above VALUE, or psnr below; may be given "
        "more than once");
    images->add_option("--stats", options.stats, "Write the figures as JSON to this file (-: standard output)");
    images->add_flag("--quiet", options.quiet, "No table");
    images->footer(std::string("Example:\n  compare images out/raster.png out/raytrace.png --fail-above rmse=0.1") +
                   kExitCodes);
    return images;
}

} // namespace

int main(int argc, char** argv) {
    return run_program("compare", [&] {
        CLI::App app("One scene, two pipelines: renders it both ways and tells what differs, and what each way cost.",
                     "compare");
        app.require_subcommand(1);
        app.footer("Example:\n  compare run models/cornell.json -o out\n\n`compare SUBCOMMAND --help` explains each.");
        RunArguments run_arguments;
        compare::ImagesOptions images_options;
        const CLI::App* run = add_run(app, run_arguments);
        add_images(app, images_options);
        const ParsedCommandLine parsed = parse_command_line(app, argc, argv);
        if (!parsed.proceed) return parsed.exit_code;
        if (!run->parsed()) return compare::compare_images(images_options);
        if (!run_arguments.size.empty()) run_arguments.options.size = parse_picture_size(run_arguments.size);
        return compare::run(run_arguments.options);
    });
}

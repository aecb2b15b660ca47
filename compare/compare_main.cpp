// The program `compare`.

#include "common/program/program.h"
#include "common/system/sabotage.h"
#include "compare/bench/bench.h"
#include "compare/frames/frames.h"
#include "compare/images.h"
#include "compare/ladder/ladder.h"
#include "compare/metrics/limits.h"
#include "compare/run.h"
#include "compare/skip/skip.h"
#include "compare/stress/suite.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <memory>

using namespace duet;

namespace {

constexpr const char* kExitCodes = "\n\nExit codes: 0 done, 1 failed (a metric over its limit, a failed test, a result "
                                   "that could not be written), 2 unusable "
                                   "arguments or input, 130 interrupted (nothing is written).";

/// A subcommand: its arguments, and what runs where it is the one that was given.
struct Subcommand {
    CLI::App* arguments;
    std::function<int()> run;
};

Subcommand add_run(CLI::App& app) {
    CLI::App* run =
        app.add_subcommand("run", "Render a scene with the rasterizer and the path tracer, and report what differs");
    const auto all = std::make_shared<compare::RunOptions>();
    const auto size = std::make_shared<std::string>();
    compare::RunOptions& options = *all;
    compare::PipelineSettings& settings = options.settings;
    run->add_option("SCENE", options.scene,
                    "A scene file (.json) or a bare mesh (.obj: framed, on a ground under a sky)")
        ->required();
    run->add_option("-o,--output", options.folder,
                    "The folder for index.html, raster.png, raytrace.png, difference.png and report.json")
        ->required();
    run->add_option("--size", *size, "Picture size WIDTHxHEIGHT (default: the scene's)");
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
    return {run, [all, size] {
                if (!size->empty()) all->size = parse_picture_size(*size);
                return compare::run(*all);
            }};
}

Subcommand add_ladder(CLI::App& app) {
    CLI::App* ladder = app.add_subcommand(
        "ladder", "Both pipelines side by side, rung by rung, and where the difference of their pictures comes from");
    const auto all = std::make_shared<compare::LadderOptions>();
    const auto size = std::make_shared<std::string>();
    compare::LadderOptions& options = *all;
    compare::PipelineSettings& settings = options.settings;
    ladder->add_option("SCENE", options.scene, "A scene file (.json) or a bare mesh (.obj)")->required();
    ladder->add_option("-o,--output", options.folder, "The folder for index.html, report.json and the pictures")
        ->required();
    ladder->add_option("--size", *size, "Picture size WIDTHxHEIGHT (default: the scene's)");
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
    ladder->add_option("--seed", settings.seed, "Seed of all random numbers (default 0)");
    ladder->add_option("--stats", options.stats,
                       "Write the figures of report.json to this file too (-: standard output)");
    ladder->add_flag("--quiet", options.quiet, "No progress bar, no table");
    ladder->footer(std::string("Example:\n  compare ladder models/cornell.json -o out --spp 256\n"
                               "then open out/index.html in a browser.") +
                   kExitCodes);
    return {ladder, [all, size] {
                if (!size->empty()) all->size = parse_picture_size(*size);
                return compare::ladder(*all);
            }};
}

Subcommand add_images(CLI::App& app) {
    CLI::App* images = app.add_subcommand("images", "Compare two picture files");
    const auto all = std::make_shared<compare::ImagesOptions>();
    compare::ImagesOptions& options = *all;
    images->add_option("A", options.a, "A picture (PNG, JPEG, TGA, PPM, PFM, HDR, EXR)")->required();
    images->add_option("B", options.reference, "The reference, of the same size")->required();
    images
        ->add_option("--fail-above", options.limits,
                     "METRIC=VALUE: exit with 1 where the metric is above VALUE, or, of psnr, ssim and z_p, below it; "
                     "may be given more than once")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    images->add_flag("--decode", options.decode,
                     "Decode 8-bit files by the sRGB curve and compare linear values throughout: needed to compare an "
                     "8-bit file with a float one");
    images->add_option("-o,--output", options.folder,
                       "A folder for the report page (index.html), difference.png and report.json");
    images->add_option("--stats", options.stats, "Write the figures as JSON to this file (-: standard output)");
    images->add_option("--threads", options.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    images->add_flag("--quiet", options.quiet, "No table");
    images->footer(
        "Metrics: " + compare::metric_names() +
        ".\n\nEXR, PFM and HDR files are linear radiance and so is all that is compared. Of 8-bit files mse, rmse, "
        "mae, "
        "psnr, ssim, worst and flip compare stored (sRGB-encoded) values, relmse, smape and mean_signed_error linear "
        "ones. The z metrics need EXR files with variances (raytrace --aov variance) of two seeds." +
        "\n\nExample:\n  compare images out/raster.png out/raytrace.png --fail-above rmse=0.1 --fail-above ssim=0.8\n"
        "  compare images before.exr after.exr -o out\nthen open out/index.html in a browser." +
        kExitCodes);
    return {images, [all] { return compare::compare_images(*all); }};
}

Subcommand add_skip(CLI::App& app) {
    CLI::App* skip = app.add_subcommand(
        "skip",
        "Switch each skip of both pipelines off in turn: the time it saves, and proof that the picture is the same");
    const auto all = std::make_shared<compare::SkipOptions>();
    const auto size = std::make_shared<std::string>();
    compare::SkipOptions& options = *all;
    skip->add_option("SCENE", options.scene, "A scene file (.json) or a bare mesh (.obj)")->required();
    skip->add_option("--size", *size,
                     "Picture size WIDTHxHEIGHT (default: the scene's shape, its longer side 128 pixels)");
    skip->add_option("--spp", options.settings.raytrace_spp, "The path tracer's samples a pixel (default 4)")
        ->check(CLI::Range(1, 1 << 20));
    skip->add_option("--raster-spp", options.settings.raster_spp, "The rasterizer's samples a pixel (default 4)")
        ->check(CLI::Range(1, 1 << 20));
    skip->add_option("--repeats", options.measure.repeats, "Pictures each way, in turns (default 5)")
        ->check(CLI::Range(1, 10000));
    skip->add_option("--budget", options.measure.budget,
                     "Seconds at most for each skip whose pictures differ in bits: they are rendered in pairs until a "
                     "bias of 0.1 % would be found with 99 % power (default 120)")
        ->check(CLI::Range(0.0, 1e7));
    skip->add_option("--only", options.only,
                     "A skip by name (raster/back_faces, or lens for both pipelines'); may be given more than once")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    skip->add_option("--threads", options.settings.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    skip->add_option("--seed", options.measure.seed, "The first seed; each repeat takes the next (default 0)");
    skip->add_option("--stats", options.stats, "Write the rows as JSON to this file (-: standard output)");
    skip->add_flag("--quiet", options.quiet, "No table, no progress bar");
    skip->footer(std::string("Example:\n  compare skip models/cornell.json --only russian_roulette\n\n"
                             "A skip is proved where all pictures have the same bits with and without it, or where no "
                             "bias is found by a test that would find one of 0.1 %; else the exit code is 1.") +
                 kExitCodes);
    return {skip, [all, size] {
                all->size = size->empty() ? PictureSize{0, 0} : parse_picture_size(*size);
                return compare::skip(*all);
            }};
}

Subcommand add_bench(CLI::App& app) {
    CLI::App* bench = app.add_subcommand("bench", "Measure run time against error: techniques, samplers, samples");
    const auto all = std::make_shared<compare::BenchOptions>();
    const auto size = std::make_shared<std::string>();
    const auto excluded = std::make_shared<std::vector<std::string>>();
    compare::BenchOptions& options = *all;
    bench->add_option("SCENE", options.scenes, "Scene files (.json) or bare meshes (.obj)")->required();
    bench->add_option("-o,--output", options.folder, "The folder for index.html, report.json and bench.csv");
    bench
        ->add_option("--techniques", options.choice.techniques,
                     "Of raster, path, naive (no light sampling), direct, unshadowed (default raster,path,naive)")
        ->delimiter(',');
    bench
        ->add_option("--samplers", options.choice.samplers,
                     "For each of the path tracer's techniques, of sobol, stratified, independent (default: all)")
        ->delimiter(',');
    bench->add_option("--spp", options.choice.spps, "Samples a pixel (default 1,4,16,64)")
        ->delimiter(',')
        ->check(CLI::Range(1, 1 << 20));
    bench->add_option("--peer", options.peer,
                      "cycles: measure Blender's path tracer beside ours, where Blender is installed");
    bench->add_option("--at-seconds", options.moments, "Compare errors at these times, too: 1,4,15")
        ->delimiter(',')
        ->check(CLI::PositiveNumber);
    bench->add_option("--repeats", options.measure.repeats, "Seeds a measurement, at least 2 (default 5)")
        ->check(CLI::Range(2, 10000));
    bench
        ->add_option("--time-limit", options.measure.time_limit,
                     "Begin no further seed after measuring a scene this long, seconds (default 600); two are made")
        ->check(CLI::PositiveNumber);
    bench->add_option("--size", *size, "Picture size WIDTHxHEIGHT (default: the scene's shape with 65536 pixels)");
    bench->add_option("--depth", options.choice.depth, "The path tracer's scattering events at most (default 64)")
        ->check(CLI::Range(0, 1 << 20));
    bench->add_option("--threads", options.choice.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    bench->add_option("--seed", options.measure.seed, "Seeds count up from the one after this (default 0)")
        ->check(CLI::Range(0, 1 << 30));
    bench->add_option(
        "--exclude", *excluded,
        "x0,y0,x1,y1: report the error without this rectangle, too: in pixels, or in parts of the picture "
        "where none is above 1; may be given more than once");
    bench->add_option(
        "--references", options.references,
        "The folder where references are kept (default: duet/references below $XDG_CACHE_HOME or ~/.cache)");
    bench
        ->add_option("--reference-spp", options.reference_spp,
                     "The references' samples a pixel (default: 16 times the most of --spp)")
        ->check(CLI::Range(2, 1 << 24));
    bench->add_option("--baseline", options.baseline,
                      "report.json of an earlier run: exit with 1 where a row is now slower or less accurate");
    bench
        ->add_option("--drift", options.drift,
                     "By what part a machine's pace may change between runs (default 0.15): slower or faster by no "
                     "more is no finding")
        ->check(CLI::Range(0.0, 10.0));
    bench->add_option("--stats", options.stats,
                      "Write the figures of report.json to this file too (-: standard output)");
    bench->add_flag("--quiet", options.quiet, "No progress bar, no tables");
    bench->footer(std::string("Example:\n  compare bench models/cornell.json models/furnace.json -o out --exclude "
                              "0.35,0.05,0.65,0.2\nthen open out/index.html in a browser.") +
                  kExitCodes);
    return {bench, [all, size, excluded] {
                if (!size->empty()) all->size = parse_picture_size(*size);
                for (const std::string& text : *excluded)
                    all->excluded.push_back(compare::parse_excluded_rectangle(text));
                return compare::bench(*all);
            }};
}

Subcommand add_stress(CLI::App& app) {
    CLI::App* stress = app.add_subcommand(
        "stress", "Test the numerics of both pipelines, and show what the books' way would have done");
    const auto all = std::make_shared<compare::StressOptions>();
    compare::StressOptions& options = *all;
    stress->add_option("--trials", options.factor, "Times the default number of trials (default 1: about a minute)")
        ->check(CLI::Range(1e-6, 1e6));
    stress->add_option("--only", options.only,
                       "A test, or how the names of some begin: intersection, departure/self-hits; may be given more "
                       "than once");
    stress->add_flag("--list", options.list, "Say what each test is, its bound and the bound's source; run none");
    stress->add_option("--seed", options.seed, "Seed of all random numbers (default 0)");
    stress->add_option("--threads", options.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    stress->add_option("--stats", options.stats, "Write the rows as JSON to this file (-: standard output)");
    if constexpr (kSabotageBuild)
        stress->add_option("--sabotage", options.sabotage,
                           "Take a guard of the numerics away: the test that --list names with it must fail");
    stress->add_flag("--quiet", options.quiet, "No table, no progress bar; failures are still explained");
    stress->footer(std::string("Example:\n  compare stress --only intersection --trials 10") + kExitCodes);
    return {stress, [all] { return compare::stress(*all); }};
}

Subcommand add_frames(CLI::App& app) {
    CLI::App* frames = app.add_subcommand("frames", "Measure the rasterizer's frames a second, beside Mesa's llvmpipe");
    const auto all = std::make_shared<compare::FramesOptions>();
    const auto size = std::make_shared<std::string>();
    const auto no_peer = std::make_shared<bool>(false);
    compare::FramesOptions& options = *all;
    frames->add_option("MESH", options.meshes, "Meshes (.obj)")->required();
    using compare::FrameView, compare::FrameWork;
    frames->add_option("--view", options.views, "whole, close (it fills most of the picture) or both (default)")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, FrameView>{{"whole", FrameView::kWhole}, {"close", FrameView::kClose}}));
    frames->add_option("--work", options.works, "phong, depth (a depth-only pass) or both (default)")
        ->delimiter(',')
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, FrameWork>{{"phong", FrameWork::kPhong}, {"depth", FrameWork::kDepth}}));
    frames->add_option("--threads", options.threads,
                       "Numbers of threads, each bound to as many processors (default: 1 and all)")
        ->delimiter(',')
        ->check(CLI::Range(1, 1024));
    frames->add_option("--size", *size, "Picture size WIDTHxHEIGHT (default 1920x1080)");
    frames->add_option("--repeats", options.settings.repeats, "Repeats of each row, ours and the peer's in turns (default 9)")
        ->check(CLI::Range(1, 10000));
    frames->add_flag("--processor-time", options.settings.processor_time,
                     "Count the seconds of all processors instead of the clock's: on a machine that others use, too");
    frames->add_flag("--no-peer", *no_peer, "Measure the rasterizer alone");
    frames->add_option("-o,--output", options.folder, "A folder for the pictures of both");
    frames->add_option("--stats", options.stats, "Write the rows as JSON to this file (-: standard output)");
    frames->add_flag("--quiet", options.quiet, "No table, no progress bar");
    frames->footer(std::string("A frame is: clear, transform, shade by Phong's model with interpolated normals, encode to "
                               "8-bit sRGB in memory; back faces are culled. Both draw the same mesh by the same matrices "
                               "under the same light; where their pictures differ the exit code is 1. A ratio above 1 is "
                               "the rasterizer ahead.\n\nExample:\n  compare frames models/generated/octopus.obj "
                               "--threads 1 --view close") +
                   kExitCodes);
    return {frames, [all, size, no_peer] {
                if (!size->empty()) {
                    const PictureSize parsed = parse_picture_size(*size);
                    all->settings.width = parsed.width;
                    all->settings.height = parsed.height;
                }
                all->settings.peer = !*no_peer;
                return compare::frames(*all);
            }};
}

} // namespace

int main(int argc, char** argv) {
    return run_program("compare", [&] {
        CLI::App app("One scene, two pipelines: renders it both ways and tells what differs, and what each way cost.",
                     "compare");
        app.require_subcommand(1);
        app.footer("Example:\n  compare run models/cornell.json -o out\n\n`compare SUBCOMMAND --help` explains each.");
        const std::vector<Subcommand> subcommands = {add_run(app),  add_ladder(app), add_images(app),
                                                     add_skip(app), add_bench(app),  add_stress(app),
                                                     add_frames(app)};
        const ParsedCommandLine parsed = parse_command_line(app, argc, argv);
        if (!parsed.proceed) return parsed.exit_code;
        for (const Subcommand& subcommand : subcommands)
            if (subcommand.arguments->parsed()) return subcommand.run();
        return kExitUnusable; // not reached: one subcommand is required
    });
}

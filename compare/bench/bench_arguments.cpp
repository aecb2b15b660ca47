// Command-line arguments of `compare bench`.
#include "common/program/option_checks.h"
#include "common/program/render_program.h"
#include "compare/arguments.h"
#include "compare/bench/bench.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace duet::compare {

Subcommand add_bench(CLI::App& app) {
    CLI::App* bench = app.add_subcommand("bench", "Measure run time against error: techniques, samplers, samples");
    const auto all = std::make_shared<BenchOptions>();
    const auto size = std::make_shared<std::string>();
    const auto excluded = std::make_shared<std::vector<std::string>>();
    BenchOptions& options = *all;
    bench->add_option("SCENE", options.scenes, "Scene files (.json) or bare meshes (.obj)")->required();
    bench->add_option("-o,--output", options.folder,
                      "The folder for index.html, report.json, bench.csv and a plot of each scene, SCENE.svg");
    bench
        ->add_option("--techniques", options.choice.techniques,
                     "Of raster, path, adaptive (path with more samples where the error is), no-roulette (path, no "
                     "path ended early), naive (no light sampling), direct, unshadowed (default raster,path,naive)")
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
    bench->add_option("--at-seconds", options.equal_times_seconds, "Compare errors at these times, too: 1,4,15")
        ->delimiter(',')
        ->check(positive_number());
    bench->add_option("--repeats", options.measure.repeats, "Seeds a measurement, at least 2 (default 5)")
        ->check(CLI::Range(2, 10000));
    bench
        ->add_option("--time-limit", options.measure.time_limit,
                     "Begin no further seed after measuring a scene this long, seconds (default 600); two are made")
        ->check(positive_number());
    bench->add_option("--size", *size, "Image size WIDTHxHEIGHT (default: the scene's shape with 65536 pixels)");
    bench->add_option("--depth", options.choice.depth, "The path tracer's scattering events at most (default 64)")
        ->check(CLI::Range(0, 1 << 20));
    bench->add_option("--threads", options.choice.threads, "Threads (default: all)")->check(CLI::Range(1, 1024));
    bench->add_option("--seed", options.measure.seed, "Seeds count up from the one after this (default 0)")
        ->check(CLI::Range(0, 1 << 30));
    bench->add_option("--exclude", *excluded,
                      "x0,y0,x1,y1: report the error without this rectangle, too: in pixels, or in parts of the image "
                      "where none is above 1; may be given more than once");
    bench->add_option(
        "--references", options.references,
        "The folder where references are kept (default: duet/references below $XDG_CACHE_HOME or ~/.cache)");
    bench
        ->add_option("--reference-spp", options.reference_spp,
                     "The references' samples a pixel (default: 16 times the most of --spp)")
        ->check(CLI::Range(2, 1 << 24));
    bench
        ->add_option("--check-spp", options.check_spp,
                     "Samples a pixel of naive's and the peer's references, which check ours (default: as many as "
                     "it has)")
        ->check(CLI::Range(2, 1 << 24));
    bench->add_option("--baseline", options.baseline,
                      "report.json of an earlier run: exit with 1 where a row is now slower or less accurate");
    bench
        ->add_option("--drift", options.drift,
                     "By what part a machine's pace may change between runs (default 0.15): slower or faster by no "
                     "more is no finding")
        ->check(number_in_range(0, 10, "a number from 0 to 10"));
    bench->add_option("--stats", options.stats,
                      "Write the figures of report.json to this file too (-: standard output)");
    bench->add_flag("--quiet", options.quiet, "No progress bar, no tables");
    bench->footer(std::string("Example:\n  compare bench models/cornell.json models/furnace.json -o out --exclude "
                              "0.35,0.05,0.65,0.2\nthen open out/index.html in a browser.") +
                  kExitCodes);
    return {bench, [all, size, excluded] {
                if (!size->empty()) all->size = parse_image_size(*size);
                for (const std::string& text : *excluded)
                    all->excluded.push_back(parse_excluded_rectangle(text));
                return compare::bench(*all);
            }};
}

} // namespace duet::compare

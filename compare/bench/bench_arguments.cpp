// This file declares the command-line arguments of `compare bench`.
#include "common/program/command_line.h"
#include "compare/arguments.h"
#include "compare/bench/bench.h"
#include "raytrace/settings.h"

namespace duet::compare {

void add_bench(CommandLine& program) {
    CommandLine& bench =
        program.add_subcommand("bench", "Measure run time against error: techniques, samplers, samples");
    BenchOptions& options = set_action(bench, compare::bench);
    bench.add("SCENE", options.scenes, "Scene files (.json) or bare meshes (.obj)").required();
    bench.add("-o,--output", options.folder,
              "The folder for index.html, report.json, bench.csv and a plot of each scene, SCENE.svg");
    bench
        .add("--techniques", options.choice.techniques,
             "Of raster, path, adaptive (path with more samples where the error is), denoised (path, then the "
             "denoiser, its time included), no-roulette (path, no path ended early), naive (no light sampling), "
             "bidirectional, vcm, photons, metropolis, direct, unshadowed (default raster,path,naive)")
        .comma_separated();
    bench
        .add("--samplers", options.choice.samplers,
             "For each of the path tracer's techniques, of sobol, stratified, independent (default: all)")
        .comma_separated();
    bench.add("--spp", options.choice.spps, "Samples per pixel (default 1,4,16,64)")
        .comma_separated()
        .range(1, 1 << 20);
    bench.add("--peer", options.peer,
              "Measure Blender's path tracer (cycles) or rasterizer (eevee, which also needs xvfb) beside ours");
    bench.add("--at-seconds", options.equal_times_seconds, "Compare errors at these times, too: 1,4,15")
        .comma_separated()
        .positive();
    bench.add("--repeats", options.measure.repeats, "Seeds a measurement, at least 2 (default 5)").range(2, 10000);
    bench
        .add("--time-limit", options.measure.time_limit,
             "Begin no further seed after measuring a scene this long, seconds (default 600); two are made")
        .positive();
    bench.add("--size", options.size, "Image size WIDTHxHEIGHT (default: the scene's shape with 65536 pixels)");
    bench.add("--depth", options.choice.depth, "The path tracer's scattering events at most (default 64)")
        .range(0, raytrace::PathTracerSettings::kMostDepth);
    bench.add("--threads", options.choice.threads, "Threads (default: all)").range(1, 1024);
    bench.add("--seed", options.measure.seed, "Seeds count up from the one after this (default 0)").range(0, 1 << 30);
    bench.add_parsed(
        "--exclude",
        [&](const auto& rectangles) {
            for (const std::string& rectangle : rectangles)
                options.excluded.push_back(parse_excluded_rectangle(rectangle));
        },
        "x0,y0,x1,y1: report the error without this rectangle, too: in pixels, or in parts of the image where none is "
        "above 1; may be given more than once");
    bench.add("--references", options.references,
              "The folder where references are kept (default: duet/references below $XDG_CACHE_HOME or ~/.cache)");
    bench.add("--reference-by", options.reference_by,
              "The integrator that renders references: path (default), or where that is lost bidirectional, vcm or "
              "photons. Only path's are checked against others");
    bench
        .add("--reference-spp", options.reference_spp,
             "The references' samples per pixel (default: 16 times the most of --spp)")
        .range(2, 1 << 24);
    bench
        .add("--check-spp", options.check_spp,
             "Samples per pixel of naive's and the peer's references, which check ours (default: as many as "
             "it has)")
        .range(2, 1 << 24);
    bench.add("--baseline", options.baseline,
              "report.json of an earlier run: exit with 1 where a row is now slower or less accurate");
    bench
        .add("--drift", options.drift,
             "Fraction by which the processor's speed may differ between runs (default 0.15); smaller changes are "
             "not reported")
        .number_range(0, 10, "a number from 0 to 10");
    bench.add("--stats", options.stats, "Write the figures of report.json to this file too (-: standard output)");
    bench.add_flag("--quiet", options.quiet, "No progress bar, no tables");
    set_footer(bench, "Example:\n  compare bench models/cornell.json models/furnace.json -o out --exclude "
                      "0.35,0.05,0.65,0.2\nthen open out/index.html in a browser.");
}

} // namespace duet::compare

#include "compare/run.h"

#include "common/image/image_file.h"
#include "common/program/program.h"
#include "common/program/statistics.h"
#include "common/system/file.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"
#include "compare/hits/hit_agreement.h"
#include "compare/metrics/image_metrics.h"
#include "compare/report/false_color.h"
#include "compare/report/output.h"
#include "compare/report/report_json.h"
#include "compare/report/report_page.h"

#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

namespace duet::compare {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Holds the results of one renderer.
struct RendererResult {
    Rendering rendering;
    Image<Hit> hits;
    RenderContext context;
};

/// Renders the image, then the hits. Returns nothing after an interrupt signal.
std::optional<RendererResult> run_renderer(const Renderer& renderer, const View& view, const RunOptions& options,
                                           const InterruptFlag& interrupt) {
    RendererResult side;
    ProgressBar bar(renderer.name, options.quiet);
    Control control = bar.control(interrupt);
    Stopwatch watch;
    side.rendering = renderer.render_image(view, control);
    side.context.render_seconds = watch.lap();
    side.context.prepare_seconds = renderer.prepare_seconds;
    Control hits_control{&interrupt.flag(), {}};
    if (!interrupt.raised()) side.hits = renderer.render_hits(view, hits_control).hit;
    if (interrupt.raised()) return {};
    return side;
}

void fill_context(RenderContext& context, const std::string& program, const RunOptions& options, const View& view,
                  double load_seconds) {
    context.program = program;
    context.scene = options.scene.string();
    context.width = view.width;
    context.height = view.height;
    context.threads = options.settings.threads > 0 ? options.settings.threads : available_threads();
    context.seed = options.settings.seed;
    context.load_seconds = load_seconds;
}

/// Writes a side's image and records the time it took.
void write_rendering(RendererResult& side, const fs::path& path, const ViewTransform& view_transform) {
    const Stopwatch watch;
    write_image(path, side.rendering.radiance, {.view = view_transform});
    side.context.write_seconds = watch.seconds();
}

ReportImage report_image(const std::string& name, const RendererResult& side) {
    return {name, side.rendering.radiance, ReportRendering{side.context, side.rendering.statistics}};
}

void print_summary(const fs::path& page, const RendererResult& raster, const RendererResult& raytrace,
                   const HitAgreement& hits, const ImageMetrics& metrics) {
    std::cerr << "raster:   " << format_duration(raster.context.prepare_seconds + raster.context.render_seconds) << '\n'
              << "raytrace: " << format_duration(raytrace.context.prepare_seconds + raytrace.context.render_seconds)
              << '\n'
              << "hits:     " << hits.same << " of " << hits.pixels << " the same, " << hits.edge << " at edges, "
              << hits.depth_tie << " depth ties, " << hits.unexplained << " unexplained\n"
              << "relmse:   " << metrics.errors.relmse << '\n'
              << "report:   " << page.string() << '\n';
}

} // namespace

int run(const RunOptions& options) {
    check_json_path(options.stats);
    const InterruptFlag interrupt;
    Stopwatch watch;
    const Scene scene = load_scene(options.scene, options.scene_options);
    const double load_seconds = watch.seconds();
    const fs::path folder = make_folder(options.folder);
    const View view = scene_view(scene);

    std::optional<RendererResult> raster =
        run_renderer(raster_renderer(scene, options.settings), view, options, interrupt);
    if (!raster) return kExitInterrupted;
    std::optional<RendererResult> raytrace =
        run_renderer(raytrace_renderer(scene, options.settings), view, options, interrupt);
    if (!raytrace) return kExitInterrupted;
    fill_context(raster->context, "raster", options, view, load_seconds);
    fill_context(raytrace->context, "raytrace", options, view, load_seconds);

    const ImageRgb &a = raster->rendering.radiance, &b = raytrace->rendering.radiance;
    const ImageMetrics metrics = image_metrics(a, b, Encoding::kLinear, options.settings.threads);
    const HitAgreement agreement = compare_hits(scene, view, raster->hits, raytrace->hits, options.settings.threads);
    if (interrupt.raised()) return kExitInterrupted;

    const ViewTransform view_transform = options.view_transform.applied_to(scene.view_transform);
    write_rendering(*raster, folder / "raster.png", view_transform);
    write_rendering(*raytrace, folder / "raytrace.png", view_transform);
    const double range = difference_range(a, b);
    write_image(folder / "difference.png", difference_image(a, b, range));
    const json report = {{"raster", statistics_json(raster->context, raster->rendering.statistics)},
                         {"raytrace", statistics_json(raytrace->context, raytrace->rendering.statistics)},
                         {"metrics", metrics_json(metrics, "raster", "raytrace")},
                         {"hits", hits_json(agreement, scene)},
                         {"difference_range", range}};
    write_json(folder / "report.json", report);
    write_file(folder / "index.html", report_page({scene.path.filename().string(), report_image("Rasterizer", *raster),
                                                   report_image("Path tracer", *raytrace), metrics, Encoding::kLinear,
                                                   ReportHits{scene, raster->hits, raytrace->hits, agreement},
                                                   view_transform}));
    if (!options.stats.empty()) write_json(options.stats, report);
    if (!options.quiet) print_summary(folder / "index.html", *raster, *raytrace, agreement, metrics);
    return kExitOk;
}

} // namespace duet::compare

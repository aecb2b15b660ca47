#include "compare/ladder/ladder.h"

#include "common/image/image_file.h"
#include "common/program/program.h"
#include "common/program/statistics.h"
#include "common/system/file.h"
#include "common/system/stopwatch.h"
#include "compare/ladder/ladder_report.h"
#include "compare/progress.h"
#include "compare/report/false_color.h"
#include "compare/report/output.h"

#include <iostream>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

namespace fs = std::filesystem;

/// Renders and measures everything. After an interrupt signal, the result is incomplete and must not be used.
LadderResult measure_ladder(const Scene& scene, const View& view, const LadderOptions& options,
                            const InterruptFlag& interrupt) {
    const Stopwatch watch;
    const PreparedPair pair = prepare_pair(scene, options.settings);
    LadderResult result{scene, view, options.settings, plan_rungs(scene, pair), {}, {}, {}, {}, {}, 0};
    const double evaluation_cost = 1.5 * pair.raytrace_settings.samples_per_pixel;
    ProgressBar bar("ladder", options.quiet);
    const Control whole = bar.control(interrupt);
    ProgressSteps steps(whole, measuring_cost(result.plan) + evaluation_cost);
    result.rungs = measure_rungs(scene, view, result.plan, options.settings.threads,
                                 [&](double cost) { return steps.next(cost); });
    const MeasuredQuantity& everything = result.rungs.back().front();
    Control control = steps.next(evaluation_cost);
    result.images = evaluate_ladder(everything.raster.image, pair, view, control);
    if (control.stopped()) return result;
    result.metrics =
        image_metrics(everything.raster.image, everything.raytrace.image, Encoding::kLinear, options.settings.threads);
    result.shares = shares(result.images);
    result.map = map_causes(result.images);
    result.seconds = watch.seconds();
    return result;
}

void write_images(const fs::path& folder, const LadderResult& result) {
    for (std::size_t k = 0; k < kRungCount; ++k)
        for (const MeasuredQuantity& q : result.rungs[k]) {
            write_image(folder / message(k + 1, '-', q.name, "-raster.png"), q.raster.image);
            write_image(folder / message(k + 1, '-', q.name, "-raytrace.png"), q.raytrace.image);
        }
    const double range = difference_range(result.images.first, result.images.image(kRungCount));
    for (std::size_t k = 0; k <= kRungCount; ++k) {
        const ImageRgb image = result.images.image(k);
        write_image(folder / message("image-", k, ".png"), image);
        if (k > 0)
            write_image(folder / message("change-", k, ".png"),
                        difference_image(result.images.image(k - 1), image, range));
    }
    write_image(folder / "cause.png", cause_image(result.map));
}

} // namespace

int ladder(const LadderOptions& options) {
    check_json_path(options.stats);
    const InterruptFlag interrupt;
    const Scene scene = load_scene(options.scene, options.scene_options);
    const fs::path folder = make_folder(options.folder);
    const View view = scene_view(scene);
    const LadderResult result = measure_ladder(scene, view, options, interrupt);
    if (interrupt.raised()) return kExitInterrupted;

    const nlohmann::json report = ladder_json(result);
    write_images(folder, result);
    write_json(folder / "report.json", report);
    write_file(folder / "index.html", ladder_page(result, report));
    if (!options.stats.empty()) write_json(options.stats, report);
    if (!options.quiet) {
        print_ladder(std::cerr, result);
        std::cerr << "report: " << (folder / "index.html").string() << '\n';
    }
    return kExitOk;
}

} // namespace duet::compare

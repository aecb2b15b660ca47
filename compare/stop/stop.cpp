#include "compare/stop/stop.h"

#include "common/program/program.h"
#include "common/program/statistics.h"
#include "compare/bench/render_reference.h"
#include "compare/renderer.h"
#include "compare/report/text.h"
#include "raytrace/render.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

/// Holds the time that deviates most from the requested one, as their ratio, and whether any time is out of tolerance.
struct WorstTime {
    double ratio = 1;
    bool missed = false;
};
WorstTime worst_time(const StopResult& result, double requested) {
    WorstTime worst;
    for (const TimeTrial& trial : result.times) {
        const double ratio = trial.seconds / requested;
        if (std::abs(std::log(ratio)) > std::abs(std::log(worst.ratio))) worst.ratio = ratio;
        if (std::abs(trial.seconds - requested) > std::max(kTimeTolerance * requested, trial.one_pass))
            worst.missed = true;
    }
    return worst;
}

struct Row {
    std::string scene;
    View view;
    StopResult result;
    double error_ratio = 0; ///< achieved / requested
    WorstTime time;

    /// Returns whether the error is out of tolerance. A smaller error is acceptable if no render could have
    /// stopped sooner.
    bool missed_error() const {
        if (result.caustics || (result.stopped_at_minimum() && error_ratio < 1)) return false;
        return !(std::abs(error_ratio - 1) <= kErrorTolerance); // true for NaN
    }
};

json as_json(const Row& row, const StopOptions& options) {
    json trials = json::array();
    for (const StopTrial& t : row.result.trials)
        trials.push_back(
            {{"seed", t.seed},
             {"samples_per_pixel", t.samples},
             {"seconds", t.seconds},
             {"stated_relmse", t.estimated_relmse},
             {"relmse", t.relmse},
             {"mse", t.mse},
             {"even", {{"seconds", t.uniform_seconds}, {"relmse", t.uniform_relmse}, {"mse", t.uniform_mse}}}});
    json times = json::array();
    for (const TimeTrial& t : row.result.times) times.push_back(t.seconds);
    return {{"scene", row.scene},
            {"width", row.view.width},
            {"height", row.view.height},
            {"asked_relmse", options.settings.error},
            {"median_relmse", row.result.median_error()},
            {"caustics", row.result.caustics},
            {"at_once", row.result.stopped_at_minimum()},
            {"samples_per_pixel", row.result.mean_samples()},
            {"adaptive_to_even", {{"relmse", row.result.cost_ratio_relmse()}, {"mse", row.result.cost_ratio_mse()}}},
            {"missed", row.missed_error() || row.time.missed},
            {"trials", trials},
            {"seconds_to_time", times}};
}

/// Returns the ratio with two decimals, or "-" if it is not finite.
std::string ratio_text(double ratio) { return std::isfinite(ratio) ? fixed(ratio, 2) : "-"; }

void print_head(bool times) {
    std::printf("%-24s %9s  %9s  %9s  %16s  %8s%s\n", "", "size", "error got", "samples", "adaptive / even", "seconds",
                times ? "  time got" : "");
    std::printf("%-24s %9s  %9s  %9s  %8s%8s\n", "", "", "/ asked", "a pixel", "relMSE", "MSE");
}

void print_row(const Row& row, const StopOptions& options) {
    double seconds = 0;
    for (const StopTrial& t : row.result.trials) seconds += t.seconds / static_cast<double>(row.result.trials.size());
    std::printf("%-24s %4dx%-4d  %9.2f  %9.0f  %8s%8s  %8.2f", row.scene.c_str(), row.view.width, row.view.height,
                row.error_ratio, row.result.mean_samples(), ratio_text(row.result.cost_ratio_relmse()).c_str(),
                ratio_text(row.result.cost_ratio_mse()).c_str(), seconds);
    if (options.settings.time > 0) std::printf("  %8.2f", row.time.ratio);
    std::printf("%s%s%s\n",
                row.result.caustics               ? "  (caustics)"
                : row.result.stopped_at_minimum() ? "  (at once)"
                                                  : "",
                row.missed_error() ? "  MISSED" : "", row.time.missed ? "  TIME MISSED" : "");
    std::fflush(stdout);
}

std::optional<Row> measured(const StopOptions& options, const std::filesystem::path& path,
                            const InterruptFlag& interrupt) {
    const Scene scene = load_scene(path);
    const double scale = std::min(1.0, 96.0 / std::max(scene.width, scene.height));
    Row row{path.filename().string(), scene_view(scene, options.size, scale), {}, 0, {}};
    const auto with_bar = [&](const char* what, const auto& work) {
        ProgressBar bar(scene.path.stem().string() + what, options.quiet);
        Control control = bar.control(interrupt);
        return work(control);
    };
    const CachedReference cached = with_bar(": reference", [&](Control& control) {
        const ReferenceSettings settings{options.references, options.reference_spp,
                                         raytrace::PathTracerSettings().max_depth, options.settings.threads};
        return reference_by("path", scene, row.view, settings, control);
    });
    if (!cached) return std::nullopt;
    std::optional<StopResult> result = with_bar(": measuring", [&](Control& control) {
        return measure_stop(scene, row.view, cached.reference, options.settings, control);
    });
    if (!result) return std::nullopt;
    row.result = std::move(*result);
    row.error_ratio = row.result.median_error() / options.settings.error;
    row.time = worst_time(row.result, options.settings.time);
    return row;
}

} // namespace

int stop(const StopOptions& given) {
    StopOptions options = given;
    check_json_path(options.stats);
    if (options.references.empty()) options.references = default_reference_folder();
    const bool table = !options.quiet && options.stats != "-";
    const InterruptFlag interrupt;
    json rows = json::array();
    bool missed = false;
    if (table) print_head(options.settings.time > 0);
    for (const std::filesystem::path& path : options.scenes) {
        const std::optional<Row> row = measured(options, path, interrupt);
        if (!row) return kExitInterrupted;
        if (table) print_row(*row, options);
        rows.push_back(as_json(*row, options));
        missed = missed || row->missed_error() || row->time.missed;
    }
    if (!options.stats.empty()) write_json(options.stats, {{"rows", rows}});
    if (missed) std::cerr << "compare: a render did not end where it was told to\n";
    return missed ? kExitFailed : kExitOk;
}

} // namespace duet::compare

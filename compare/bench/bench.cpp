#include "compare/bench/bench.h"

#include "common/program/program.h"
#include "common/program/render_program.h"
#include "common/program/statistics.h"
#include "common/scene/scene_hash.h"
#include "common/system/file.h"
#include "common/system/parallel.h"
#include "compare/bench/bench_report.h"
#include "compare/bench/render_reference.h"
#include "compare/peers/blender.h"
#include "compare/renderer.h"
#include "compare/report/output.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

namespace duet::compare {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

BlenderEngine engine_of(const BenchOptions& options) {
    return options.peer == "eevee" ? BlenderEngine::kEevee : BlenderEngine::kCycles;
}

/// Checks options before the long renders.
void check(const BenchOptions& options) {
    check_renderer_choice(options.choice);
    check_reference_integrator(options.reference_by);
    if (!options.peer.empty() && options.peer != "cycles" && options.peer != "eevee")
        throw Error(message("--peer: found ", options.peer, ", expected cycles or eevee"));
    if (!options.peer.empty()) check_blender(engine_of(options));
    if (!options.folder.empty()) make_folder(options.folder);
    check_json_path(options.stats);
}

json read_baseline(const fs::path& path) {
    const json report = json::parse(read_file(path), nullptr, false);
    if (report.is_discarded()) throw Error(message(path.string(), ": not JSON, expected a report of compare bench"));
    return report;
}

/// Returns the scale at which a trial takes seconds instead of minutes.
double bench_scale(const Scene& scene) {
    return std::min(1.0, 256 / std::sqrt(static_cast<double>(scene.width) * scene.height));
}

int threads_of(const BenchOptions& options) {
    return options.choice.threads > 0 ? options.choice.threads : available_threads();
}

/// Measures one scene in three steps: references, checks, trials.
class SceneBench {
public:
    SceneBench(const BenchOptions& options, const fs::path& path, const InterruptFlag& interrupt)
        : options_(options), interrupt_(interrupt), scene_(load_scene(path, SceneOptions{options.size})),
          view_(scene_view(scene_, options.size, bench_scale(scene_))),
          counted_(counted_pixels(options.excluded, view_.width, view_.height)) {
        check_supported(scene_, options.choice.techniques, options.reference_by);
        result_.scene = path.string();
        result_.scene_hash = hash_scene_files(scene_);
        result_.width = view_.width;
        result_.height = view_.height;
        if (!options.peer.empty())
            peer_ = std::make_shared<BlenderPeer>(engine_of(options), scene_, view_,
                                                  ExportSettings{options.choice.depth, threads_of(options)});
    }

    /// Returns nothing after an interrupt signal.
    std::optional<SceneResult> run() {
        find_references();
        if (!interrupt_.raised()) measure_all();
        if (interrupt_.raised()) return {};
        return std::move(result_);
    }

private:
    std::string label(const char* what) const { return message(scene_.path.stem().string(), ": ", what); }

    ReferenceSettings reference_settings(int spp) const {
        return {options_.references, spp, options_.choice.depth, options_.choice.threads};
    }

    CachedReference reference(const std::string& estimator, int spp) const {
        ProgressBar bar(label("reference by ") + estimator, options_.quiet);
        Control control = bar.control(interrupt_);
        return reference_by(estimator, scene_, view_, reference_settings(spp), control);
    }

    void check_against(CachedReference other, std::vector<std::string> approximations) {
        if (interrupt_.raised()) return;
        const BiasCheck check = check_bias(result_.reference.reference, other.reference);
        result_.checks.push_back({std::move(other), check, std::move(approximations)});
    }

    void find_references() {
        result_.reference = reference(options_.reference_by, options_.reference_spp);
        if (options_.reference_by != "path") { // only the path tracer's pixels are independent
            result_.no_naive = "the reference is by " + options_.reference_by + ", and is not checked";
            return;
        }
        result_.no_naive = naive_limitation(scene_);
        if (!interrupt_.raised() && result_.no_naive.empty()) check_against(reference("naive", options_.check_spp), {});
        if (!interrupt_.raised() && peer_ && peer_->engine() == BlenderEngine::kCycles)
            check_against(cycles_reference(), peer_->notes());
    }

    CachedReference cycles_reference() const {
        ProgressBar bar(label("reference by Cycles"), options_.quiet);
        Control control = bar.control(interrupt_);
        Control silent{&interrupt_.flag(), {}};
        const auto render = [&](int spp, std::uint64_t seed) { return peer_->unbiased_image(spp, seed, silent); };
        return reference_by_seeds({"cycles", kCyclesExportVersion, peer_->program(silent)}, scene_, view_,
                                  reference_settings(options_.check_spp), render, control);
    }

    void measure_all() {
        std::vector<BenchRenderer> renderers = duet_renderers(scene_, view_, options_.choice);
        if (peer_)
            for (BenchRenderer& c : blender_renderers(peer_, options_.choice.spps)) renderers.push_back(std::move(c));
        ProgressBar bar(label("measuring"), options_.quiet);
        Control control = bar.control(interrupt_);
        result_.rows = measure(renderers, result_.reference.reference, counted_, options_.measure, control);
        mark_best_settings(result_.rows, options_.peer);
        widen_efficiency(result_.rows, options_.drift, processor_share(result_.rows, threads_of(options_)));
        result_.equal_times = at_equal_times(result_.rows, options_.equal_times_seconds, options_.peer);
        result_.processor_share = processor_share(result_.rows, threads_of(options_));
    }

    const BenchOptions& options_;
    const InterruptFlag& interrupt_;
    const Scene scene_;
    const View view_;
    const Image<std::uint8_t> counted_;
    std::shared_ptr<BlenderPeer> peer_; ///< null: none requested
    SceneResult result_;
};

void write_report(const BenchOptions& options, const json& report) {
    if (!options.stats.empty()) write_json(options.stats, report);
    if (options.folder.empty()) return;
    write_json(options.folder / "report.json", report);
    write_file(options.folder / "bench.csv", bench_csv(report));
    write_file(options.folder / "index.html", bench_page(report));
}

void write_plots(const fs::path& folder, const std::vector<SceneResult>& results) {
    for (const SceneResult& result : results) {
        const Plot plot = bench_plot(result);
        const std::string name = fs::path(result.scene).stem().string() + ".svg";
        if (!plot.series.empty()) write_plot(folder / name, plot);
    }
}

BenchOptions with_defaults(BenchOptions options) {
    if (options.references.empty()) options.references = default_reference_folder();
    const auto& spps = options.choice.spps;
    if (options.reference_spp == 0) options.reference_spp = 16 * *std::max_element(spps.begin(), spps.end());
    if (options.check_spp == 0) options.check_spp = options.reference_spp;
    return options;
}

} // namespace

int bench(const BenchOptions& given) {
    check(given);
    const BenchOptions options = with_defaults(given);
    const bool tables = !options.quiet && options.stats != "-";
    std::optional<json> earlier;
    if (!options.baseline.empty()) {
        earlier = read_baseline(options.baseline);
        check_baseline(*earlier,
                       {options.choice.depth, threads_of(options), options.reference_spp, options.reference_by});
    }

    const InterruptFlag interrupt;
    std::vector<SceneResult> results;
    for (const fs::path& path : options.scenes) {
        std::optional<SceneResult> result = SceneBench(options, path, interrupt).run();
        if (!result) return kExitInterrupted;
        if (tables) print_scene(std::cout, *result, !options.excluded.empty());
        results.push_back(std::move(*result));
    }

    // The report is written even if the comparison with the baseline fails.
    write_report(options, bench_json(options, results, std::nullopt));
    if (!options.folder.empty()) write_plots(options.folder, results);
    std::optional<BaselineComparison> baseline;
    if (earlier) baseline = compare_with_baseline(results, *earlier, options.drift);
    if (baseline && tables) print_baseline(std::cout, *baseline);
    if (baseline) write_report(options, bench_json(options, results, baseline));

    const bool biased = std::any_of(results.begin(), results.end(), [](const SceneResult& r) {
        return std::any_of(r.checks.begin(), r.checks.end(), [](const IndependentCheck& c) { return c.failed(); });
    });
    if (biased) std::cerr << "compare: independent references of a scene disagree\n";
    const bool worse = baseline && baseline->flagged();
    if (worse) std::cerr << "compare: slower or less accurate than the baseline\n";
    return biased || worse ? kExitFailed : kExitOk;
}

} // namespace duet::compare

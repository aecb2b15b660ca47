#include "compare/bench/bench_report.h"
#include "raytrace/render.h"

#include "common/system/parallel.h"
#include "compare/report/report_json.h"

#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

json estimate_json(const Estimate& e) {
    return {{"value", number_json(e.value)},
            {"low", number_json(e.low())},
            {"high", number_json(e.high())},
            {"relative_error", number_json(e.relative_error)},
            {"dof", number_json(e.dof)}};
}

json trials_json(const std::vector<TrialResult>& trials) {
    json list = json::array();
    for (const TrialResult& t : trials)
        list.push_back({{"seed", t.seed},
                        {"seconds", t.seconds},
                        {"cpu_seconds", t.cpu_seconds},
                        {"mse", number_json(t.whole.mse)},
                        {"relmse", number_json(t.whole.relmse)},
                        {"rest_mse", number_json(t.rest.mse)},
                        {"rest_relmse", number_json(t.rest.relmse)}});
    return list;
}

json dominance_json(const std::optional<Dominance>& d) {
    return d ? json{{"ratio", estimate_json(d->ratio)}, {"at_most", d->at_most}} : json(nullptr);
}

json row_json(const SceneResult& result, const Measurement& m, bool with_rest) {
    json row = {{"technique", m.technique},
                {"sampler", m.sampler},
                {"note", m.note},
                {"spp", m.spp},
                {"counted", m.counted},
                {"repeats", m.trials.size()},
                {"mse", estimate_json(m.mse)},
                {"relmse", estimate_json(m.relmse)},
                {"seconds", estimate_json(m.seconds)},
                {"efficiency", estimate_json(m.efficiency)},
                {"relmse_efficiency", estimate_json(m.relmse_efficiency)},
                {"variance", number_json(m.variance)},
                {"dominates", dominance_json(dominance(result.rows, m))},
                {"bias_share", number_json(m.bias_share())},
                {"reference_share", number_json(m.reference_share)},
                {"trials", trials_json(m.trials)}};
    if (with_rest)
        row["rest"] = {{"mse", estimate_json(m.rest_mse)},
                       {"relmse", estimate_json(m.rest_relmse)},
                       {"efficiency", estimate_json(m.rest_efficiency)},
                       {"relmse_efficiency", estimate_json(m.rest_relmse_efficiency)}};
    return row;
}

json reference_json(const CachedReference& r) {
    return {{"estimator", r.estimator},
            {"file", r.file.string()},
            {"rendered", r.rendered},
            {"mse", number_json(r.reference.mse())}};
}

json check_json(const IndependentCheck& c) {
    const BiasCheck& check = c.check;
    return {{"other", reference_json(c.other)},
            {"approximations", c.approximations},
            {"tests", check.tests},
            {"worst_z", number_json(check.worst_z)},
            {"dof", number_json(check.worst_dof)},
            {"p_value", number_json(check.p_value)},
            {"significance", BiasCheck::kSignificance},
            {"consistent", check.consistent()},
            {"failed", c.failed()},
            {"block", {check.block_x, check.block_y, check.block_size}},
            {"channel", check.channel},
            {"relative_bias", channels_json(check.relative_bias)},
            {"detectable", number_json(check.detectable)}};
}

json equal_time_json(const EqualTimeRow& row) {
    const auto optional = [](const std::optional<Estimate>& e) { return e ? estimate_json(*e) : json(nullptr); };
    return {{"seconds", row.seconds},           {"name", row.name},
            {"mse", optional(row.mse)},         {"rest_mse", optional(row.rest_mse)},
            {"to_peer", optional(row.to_peer)}, {"rest_to_peer", optional(row.rest_to_peer)}};
}

json scene_json(const SceneResult& result, bool with_rest) {
    json rows = json::array();
    for (const Measurement& m : result.rows) rows.push_back(row_json(result, m, with_rest));
    json checks = json::array();
    for (const IndependentCheck& c : result.checks) checks.push_back(check_json(c));
    json equal_times = json::array();
    for (const EqualTimeRow& row : result.equal_times) equal_times.push_back(equal_time_json(row));
    return {{"scene", result.scene},
            {"equal_times", equal_times},
            {"hash", result.scene_hash},
            {"width", result.width},
            {"height", result.height},
            {"reference", reference_json(result.reference)},
            {"checks", checks},
            {"no_naive", result.no_naive},
            {"rows", rows},
            {"processor_share", number_json(result.processor_share)}};
}

json excluded_json(const std::vector<ExcludedRectangle>& rectangles) {
    json list = json::array();
    for (const ExcludedRectangle& r : rectangles)
        list.push_back({{"corners", {r.x0, r.y0, r.x1, r.y1}}, {"fractions", r.fractions}});
    return list;
}

json baseline_json(const BaselineComparison& comparison) {
    json rows = json::array();
    for (const BaselineRow& r : comparison.rows)
        rows.push_back({{"scene", r.scene},
                        {"technique", r.technique},
                        {"sampler", r.sampler},
                        {"spp", r.spp},
                        {"mse_ratio", estimate_json(r.mse_ratio)},
                        {"seconds_ratio", estimate_json(r.seconds_ratio)},
                        {"less_accurate", r.less_accurate},
                        {"slower", r.slower},
                        {"more_accurate", r.more_accurate},
                        {"faster", r.faster}});
    return {{"significance", BaselineComparison::kSignificance},
            {"drift", comparison.drift},
            {"flagged", comparison.flagged()},
            {"unmatched", comparison.unmatched},
            {"rows", rows}};
}

} // namespace

json bench_json(const BenchOptions& options, const std::vector<SceneResult>& results,
                const std::optional<BaselineComparison>& baseline) {
    json scenes = json::array();
    for (const SceneResult& result : results) scenes.push_back(scene_json(result, !options.excluded.empty()));
    json report = {{"program", "compare bench"},
                   {"version", DUET_VERSION},
                   {"estimator_version", raytrace::kEstimatorVersion},
                   {"threads", options.choice.threads > 0 ? options.choice.threads : available_threads()},
                   {"depth", options.choice.depth},
                   {"seed", options.measure.seed},
                   {"reference_spp", options.reference_spp},
                   {"reference_by", options.reference_by},
                   {"confidence", 0.95},
                   {"excluded", excluded_json(options.excluded)},
                   {"scenes", scenes}};
    if (baseline) report["baseline"] = baseline_json(*baseline);
    return report;
}

} // namespace duet::compare

#include "compare/bench/baseline.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

Estimate estimate(const json& value) {
    const auto number = [&](const char* key) {
        const json& v = value.at(key);
        return v.is_null() ? std::numeric_limits<double>::infinity() : v.get<double>();
    };
    return {number("value"), number("relative_error"), number("dof")};
}

Estimate scaled(Estimate e, double factor) {
    e.value *= factor;
    return e;
}

const json* find_scene(const json& scenes, const SceneResult& result) {
    for (const json& scene : scenes)
        if (scene.at("hash") == result.scene_hash && scene.at("width") == result.width &&
            scene.at("height") == result.height)
            return &scene;
    return nullptr;
}

const json* find_row(const json& rows, const Measurement& m) {
    for (const json& row : rows)
        if (row.at("technique") == m.technique && row.at("sampler") == m.sampler && row.at("spp") == m.spp) return &row;
    return nullptr;
}

BaselineRow compare_row(const std::string& scene, const Measurement& now, const json& then) {
    BaselineRow row{scene, now.technique, now.sampler, now.spp, {}, {}};
    row.mse_ratio = ratio_of(now.mse, estimate(then.at("mse")));
    row.seconds_ratio = ratio_of(now.seconds, estimate(then.at("seconds")));
    return row;
}

void find_changes(BaselineComparison& comparison) {
    const double alpha = shared_significance(BaselineComparison::kSignificance, 4 * comparison.rows.size());
    const double slack = 1 / (1 + comparison.drift);
    const auto share = [](double s) { return s > 0 && s < 1 ? s : 1.0; };
    const auto inverse = [](Estimate e) {
        e.value = 1 / e.value;
        return e;
    };
    for (BaselineRow& row : comparison.rows) {
        row.less_accurate = p_value_above_one(row.mse_ratio) < alpha;
        row.more_accurate = p_value_above_one(inverse(row.mse_ratio)) < alpha;
        row.slower = p_value_above_one(scaled(row.seconds_ratio, slack * share(row.share_now))) < alpha;
        row.faster = p_value_above_one(scaled(inverse(row.seconds_ratio), slack * share(row.share_then))) < alpha;
    }
}

/// Runs the body, which reads JSON of unknown content, and converts JSON exceptions to Error.
void with_json_errors(const std::function<void()>& body) {
    try {
        body();
    } catch (const json::exception& error) {
        throw Error(message("--baseline: not a report of compare bench: ", error.what()));
    }
}

void compare_all(const std::vector<SceneResult>& results, const json& earlier, BaselineComparison& comparison) {
    for (const SceneResult& result : results) {
        const json* const scene = find_scene(earlier.at("scenes"), result);
        for (const Measurement& m : result.rows) {
            const json* const row = scene != nullptr ? find_row(scene->at("rows"), m) : nullptr;
            if (row != nullptr) {
                comparison.rows.push_back(compare_row(result.scene, m, *row));
                comparison.rows.back().share_now = result.processor_share;
                comparison.rows.back().share_then = scene->at("processor_share").get<double>();
            } else {
                comparison.unmatched.push_back(message(result.scene, ": ", m.technique, m.sampler.empty() ? "" : ", ",
                                                       m.sampler, ", ", m.spp, " samples"));
            }
        }
    }
}

} // namespace

bool BaselineComparison::flagged() const {
    return std::any_of(rows.begin(), rows.end(), [](const BaselineRow& r) { return r.less_accurate || r.slower; });
}

void check_baseline(const json& earlier, const BenchConditions& now) {
    with_json_errors([&] {
        earlier.at("scenes");
        const auto same = [&](const char* key, int mine) {
            const int theirs = earlier.at(key).get<int>();
            if (theirs != mine)
                throw Error(message("--baseline: measured with ", key, " ", theirs, ", this run with ", mine));
        };
        same("depth", now.depth);
        same("threads", now.threads);
        same("reference_spp", now.reference_spp);
        if (const std::string theirs = earlier.value("reference_by", "path"); theirs != now.reference_by)
            throw Error(message("--baseline: measured with a reference by ", theirs, ", this run with one by ",
                                now.reference_by));
    });
}

BaselineComparison compare_with_baseline(const std::vector<SceneResult>& results, const json& earlier, double drift) {
    BaselineComparison comparison;
    comparison.drift = drift;
    with_json_errors([&] { compare_all(results, earlier, comparison); });
    if (comparison.rows.empty())
        throw Error("--baseline: no row of this run is in it: other scene files, sizes, techniques, samplers or "
                    "samples per pixel");
    find_changes(comparison);
    return comparison;
}

} // namespace duet::compare

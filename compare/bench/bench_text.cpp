#include "compare/bench/bench_report.h"

#include "compare/report/text.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

/// Returns text such as "0.0123 ± 4 %", with the upper half-width of the 95 % confidence band.
std::string with_band(const Estimate& e) {
    const double percent = 100 * (e.high() / e.value - 1);
    return formatted("%9.3g", e.value) + (std::isfinite(percent) ? formatted(" ±%3.0f %%", percent) : "   ?   ");
}

/// Returns a CSV field, quoted if necessary (RFC 4180).
std::string csv_field(const json& value) {
    if (value.is_null()) return "";
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted(1, '"');
    for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
    quoted += '"';
    return quoted;
}

/// Returns text such as "12.3", "< 12.3" for an upper bound, or "-" for none.
std::string dominance_text(const std::optional<Dominance>& d) {
    if (!d) return "-";
    return (d->at_most ? "< " : "") + formatted("%.3g", d->ratio.value);
}

std::string verdicts(const BaselineRow& row) {
    std::vector<const char*> found;
    if (row.slower) found.push_back("SLOWER");
    if (row.less_accurate) found.push_back("LESS ACCURATE");
    if (row.faster) found.push_back("faster");
    if (row.more_accurate) found.push_back("more accurate");
    return joined(found);
}

void print_check(std::ostream& out, const std::string& estimator, const IndependentCheck& c) {
    const BiasCheck& check = c.check;
    out << "bias check, " << estimator << " against " << c.other.estimator << ": largest |z| "
        << formatted("%.2f", std::abs(check.worst_z)) << " of " << check.tests
        << " means, p = " << formatted("%.2g", check.p_value) << ": "
        << (check.consistent() ? "consistent" : "NOT CONSISTENT") << "; a bias of "
        << formatted("%.2g %%", 100 * check.detectable) << " of the whole would be found\n";
    for (const std::string& text : c.approximations) out << "  " << c.other.estimator << ": " << text << '\n';
    if (check.consistent()) return;
    static constexpr const char* kChannels[] = {"red", "green", "blue"};
    out << "  in " << kChannels[check.channel] << " of ";
    if (check.block_size > 0)
        out << "the block of " << check.block_size << " pixels from (" << check.block_x << ", " << check.block_y << ")";
    else
        out << "the whole image";
    out << "; the whole differs by "
        << formatted("%.2g, %.2g, %.2g %%\n", 100 * check.relative_bias.r, 100 * check.relative_bias.g,
                     100 * check.relative_bias.b);
}

void print_equal_times(std::ostream& out, const std::vector<EqualTimeRow>& table, bool with_rest) {
    const auto text = [](const std::optional<Estimate>& e) {
        return e ? with_band(*e) : std::string("        -        ");
    };
    if (table.empty()) return;
    out << formatted("%-9s %-26s  %17s  %17s", "at time", "", "MSE", "/ peer's");
    out << (with_rest ? formatted("  %17s  %17s\n", "MSE of the rest", "/ peer's") : "\n");
    for (const EqualTimeRow& row : table) {
        out << formatted("%-7g s %-26s  ", row.seconds, row.name.c_str()) << text(row.mse) << "  " << text(row.to_peer);
        if (with_rest) out << "  " << text(row.rest_mse) << "  " << text(row.rest_to_peer);
        out << '\n';
    }
}

} // namespace

void print_scene(std::ostream& out, const SceneResult& result, bool with_rest) {
    out << result.scene << ", " << result.width << "x" << result.height << "; the reference's own MSE is "
        << formatted("%.2g", result.reference.reference.mse()) << '\n';
    for (const IndependentCheck& c : result.checks) print_check(out, result.reference.estimator, c);
    if (!result.no_naive.empty()) out << "no bias check by naive: " << result.no_naive << '\n';
    if (result.processor_share < 0.9)
        out << formatted("the threads got %.0f %% of the processor time they could use: mistrust the times\n",
                         100 * result.processor_share);
    out << formatted("%-12s %-12s %6s  %17s  %17s  %9s  %9s  %17s  %5s", "technique", "sampler", "spp", "seconds",
                     "MSE", "relMSE", "dominates", "1/(MSE s)", "bias");
    out << (with_rest ? "  MSE of the rest\n" : "\n");
    for (const Measurement& m : result.rows) {
        out << formatted("%-12s %-12s %6d  ", m.technique.c_str(), m.sampler.c_str(), m.spp) << with_band(m.seconds)
            << "  " << with_band(m.mse) << "  "
            << formatted("%9.3g  %9s", m.relmse.value, dominance_text(dominance(result.rows, m)).c_str()) << "  "
            << with_band(m.efficiency) << formatted("  %3.0f %%", 100 * m.bias_share());
        if (with_rest) out << "  " << with_band(m.rest_mse);
        if (!m.counted) out << "  (its other setting counts)";
        if (m.reference_share > 0.1) out << formatted("  %.0f %% of it the reference's", 100 * m.reference_share);
        out << '\n';
    }
    print_equal_times(out, result.equal_times, with_rest);
}

void print_baseline(std::ostream& out, const BaselineComparison& comparison) {
    std::size_t findings = 0;
    for (const BaselineRow& row : comparison.rows) {
        const std::string text = verdicts(row);
        if (text.empty()) continue;
        ++findings;
        out << "baseline: " << row.scene << ", " << row.technique << (row.sampler.empty() ? "" : ", ") << row.sampler
            << ", " << row.spp << " samples: " << text
            << formatted(" (MSE x %.3g, time x %.3g)", row.mse_ratio.value, row.seconds_ratio.value) << '\n';
    }
    out << "baseline: " << findings << " of " << comparison.rows.size() << " rows differ significantly; "
        << comparison.unmatched.size() << " rows are not in it\n";
}

std::string bench_csv(const json& report) {
    std::string text = "scene,width,height,depth,threads,technique,sampler,spp,repeats";
    static constexpr const char* kEstimates[] = {"seconds", "mse", "relmse", "efficiency"};
    for (const char* const name : kEstimates) text += formatted(",%s,%s_low,%s_high", name, name, name);
    text += ",dominates,variance,bias_share,reference_share";
    text += ",rest_mse,rest_mse_low,rest_mse_high,rest_relmse,rest_efficiency\n";
    const auto add = [&](const json& value) {
        text += ',';
        text += csv_field(value);
    };
    const auto add_estimate = [&](const json& e) {
        for (const char* const key : {"value", "low", "high"}) add(e.at(key));
    };
    for (const json& scene : report.at("scenes"))
        for (const json& row : scene.at("rows")) {
            text += csv_field(scene.at("scene"));
            for (const json& value : {scene.at("width"), scene.at("height"), report.at("depth"), report.at("threads")})
                add(value);
            for (const char* const key : {"technique", "sampler", "spp", "repeats"}) add(row.at(key));
            for (const char* const name : kEstimates) add_estimate(row.at(name));
            add(row.at("dominates").is_null() ? json(nullptr) : row.at("dominates").at("ratio").at("value"));
            for (const char* const key : {"variance", "bias_share", "reference_share"}) add(row.at(key));
            if (row.contains("rest")) {
                add_estimate(row.at("rest").at("mse"));
                add(row.at("rest").at("relmse").at("value"));
                add(row.at("rest").at("efficiency").at("value"));
            } else {
                text += ",,,,,";
            }
            text += '\n';
        }
    return text;
}

} // namespace duet::compare

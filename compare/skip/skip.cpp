#include "compare/skip/skip.h"

#include "common/program/program.h"
#include "common/program/statistics.h"
#include "compare/report/report_json.h"
#include "compare/report/text.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

struct Row {
    SkipCase skip;
    SkipMeasurement measured;
};

std::string full_name(const SkipCase& skip) { return skip.pipeline + "/" + skip.name; }

std::vector<SkipCase> chosen(std::vector<SkipCase> all, const std::vector<std::string>& only) {
    if (only.empty()) return all;
    std::vector<std::string> known;
    for (const SkipCase& skip : all) known.push_back(full_name(skip));
    const auto meant = [](const SkipCase& skip, const std::string& name) {
        return name == skip.name || name == full_name(skip);
    };
    for (const std::string& name : only)
        if (std::none_of(all.begin(), all.end(), [&](const SkipCase& skip) { return meant(skip, name); }))
            throw Error(message("--only: found ", name, ", expected one of ", joined(known)));
    std::erase_if(all, [&](const SkipCase& skip) {
        return std::none_of(only.begin(), only.end(), [&](const std::string& name) { return meant(skip, name); });
    });
    return all;
}

double largest_bias(const BiasTest& test) {
    const Rgbd bias = test.bias();
    return std::max({std::abs(bias.r), std::abs(bias.g), std::abs(bias.b)});
}

std::string percent(double share) { return significant(100 * share, 2) + " %"; }

/// Returns what was proved, or why nothing was.
std::string verdict(const SkipMeasurement& m, double wanted) {
    if (m.pixels_differ == 0) return "same bits";
    if (!m.bias) return message("NOT THE SAME: ", m.pixels_differ, " pixels of ", m.image_pairs, " images differ");
    const BiasTest& test = *m.bias;
    const std::string found =
        message(percent(largest_bias(test)), " in ", test.pairs(), " pairs, p = ", significant(test.p(), 2));
    if (test.p() < kFalseAlarmProbability) return "BIASED by " + found;
    if (!std::isfinite(test.detectable()))
        return message("NOT PROVED: ", test.pairs(),
                       " pairs in the time given say nothing yet: a longer --budget is needed");
    const std::string power = "one of " + percent(test.detectable()) + " would be found";
    if (!m.proved)
        return message("NOT PROVED: no bias, but only ", power, " (", found, "): ", percent(wanted),
                       " needs a longer --budget");
    return "no bias: " + power + " (" + found + ")";
}

json row_json(const Row& row) {
    const SkipMeasurement& m = row.measured;
    const auto seconds = [](const SkipMeasurement::Seconds& s) { return json{{"median", s.median}, {"min", s.min}}; };
    json result = {{"pipeline", row.skip.pipeline},
                   {"name", row.skip.name},
                   {"left_out", row.skip.omitted},
                   {"reason", m.reason},
                   {"seconds_with", seconds(m.with)},
                   {"seconds_without", seconds(m.without)},
                   {"saved", m.without.median > 0 ? json(1 - m.with.median / m.without.median) : json(nullptr)},
                   {"rays_saved", m.rays_saved},
                   {"pictures", m.image_pairs},
                   {"pixels_differ", m.pixels_differ},
                   {"proof", m.pixels_differ == 0 ? "same bits"
                             : m.bias             ? "no bias"
                                                  : "none"},
                   {"proved", m.proved}};
    if (m.bias) {
        const Rgbd bias = m.bias->bias();
        result["bias"] = {{"pairs", m.bias->pairs()},
                          {"bias", {bias.r, bias.g, bias.b}},
                          {"detectable", number_json(m.bias->detectable())},
                          {"p", m.bias->p()}};
    }
    return result;
}

json report_json(const SkipOptions& options, const View& view, const std::vector<Row>& rows) {
    json list = json::array();
    for (const Row& row : rows) list.push_back(row_json(row));
    return {{"scene", options.scene.string()},
            {"width", view.width},
            {"height", view.height},
            {"raster_samples_per_pixel", options.settings.raster_spp},
            {"raytrace_samples_per_pixel", options.settings.raytrace_spp},
            {"repeats", options.measure.repeats},
            {"skips", list}};
}

void print_table(std::ostream& out, const SkipOptions& options, const View& view, const std::vector<Row>& rows) {
    const std::vector<int> widths{-27, 9, 9, 9, 9, 2, 0};
    const auto saved = [](double with, double without) {
        return message(std::lround(100 * (1 - with / without)), " %");
    };
    out << "medians of " << options.measure.repeats << " images each way of " << view.width << "x" << view.height
        << " pixels, in turns, and what is saved by medians and by minima\n";
    print_cells(out, widths, {"skip", "with ms", "without", "saved", "by min", "", "proof; what is left out (why)"});
    for (const Row& row : rows) {
        const SkipMeasurement& m = row.measured;
        print_cells(out, widths,
                    {full_name(row.skip), milliseconds(m.with.median), milliseconds(m.without.median),
                     saved(m.with.median, m.without.median), saved(m.with.min, m.without.min), "",
                     verdict(m, options.measure.bias) + "; " + row.skip.omitted +
                         (m.reason.empty() ? "" : " (" + m.reason + ")") +
                         (m.rays_saved > 0 ? message(", ", m.rays_saved, " rays") : "")});
    }
}

} // namespace

int skip(const SkipOptions& options) {
    check_json_path(options.stats);
    const InterruptFlag interrupt;
    const Scene scene = load_scene(options.scene);
    constexpr double kLongerSide = 128;
    const View view = scene_view(scene, options.size, kLongerSide / std::max(scene.width, scene.height));
    const std::vector<SkipCase> cases = chosen(skip_cases(scene, options.settings), options.only);
    std::vector<Row> rows;
    {
        ProgressBar bar("skips", options.quiet);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            Control control = bar.control(interrupt, i, cases.size());
            rows.push_back({cases[i], measure_skip(cases[i], view, options.measure, control)});
            if (interrupt.raised()) return kExitInterrupted;
        }
    }
    if (!options.quiet && options.stats != "-") print_table(std::cout, options, view, rows);
    if (!options.stats.empty()) write_json(options.stats, report_json(options, view, rows));
    int code = kExitOk;
    for (const Row& row : rows)
        if (!row.measured.proved) {
            std::cerr << "compare: " << full_name(row.skip) << ": " << verdict(row.measured, options.measure.bias)
                      << '\n';
            code = kExitFailed;
        }
    return code;
}

} // namespace duet::compare

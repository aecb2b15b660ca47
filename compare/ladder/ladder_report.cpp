#include "compare/ladder/ladder_report.h"

#include "common/program/program.h"
#include "common/system/parallel.h"
#include "compare/ladder/code_lines.h"
#include "compare/report/report_json.h"
#include "compare/report/text.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

const char* cause_title(std::size_t cause) {
    return cause == kNoise ? "noise of the path tracer" : kRungNames[cause].cause;
}

json shares_json(const LadderResult& result) {
    json list = json::array();
    for (std::size_t i = 0; i < kCauseCount; ++i)
        list.push_back({{"cause", i == kNoise ? "noise" : kRungNames[i].id},
                        {"title", cause_title(i)},
                        {"share", result.shares.negligible ? json(nullptr) : json(result.shares.share[i])},
                        {"largest_in", result.map.pixels[i]}});
    return list;
}

/// Returns the error metrics of one rung; null if no pixel is finite.
json error_json(const ErrorMetrics& m) {
    if (m.pixels == 0) return nullptr;
    return {{"rmse", m.rmse},
            {"mae", m.mae},
            {"relmse", m.relmse},
            {"mean_signed_error", {m.mean_signed_error.r, m.mean_signed_error.g, m.mean_signed_error.b}}};
}

json quantity_json(const MeasuredQuantity& q) {
    json result = {
        {"name", q.name},
        {"seconds", {{"raster", q.raster.seconds}, {"raytrace", q.raytrace.seconds}}},
        {"samples_per_pixel", {{"raster", q.raster.samples_per_pixel}, {"raytrace", q.raytrace.samples_per_pixel}}}};
    if (!q.hits) result["metrics"] = error_json(q.error);
    return result;
}

json code_json(int rung) {
    json code;
    for (const char* const side : {"raster", "raytrace", "both"})
        code[side] = {{"lines", 0}, {"files", json::object()}};
    for (const CodeFile& file : code_files()) {
        if (file.rung != rung) continue;
        json& side = code[std::string(file.side)];
        side["lines"] = side["lines"].get<int>() + file.lines;
        side["files"][std::string(file.path)] = file.lines;
    }
    return code;
}

json rung_json(const LadderResult& result, std::size_t k) {
    json quantities = json::array();
    for (const MeasuredQuantity& q : result.rungs[k]) {
        quantities.push_back(quantity_json(q));
        if (q.hits) quantities.back()["hits"] = hits_json(*q.hits, result.scene);
    }
    const RungPlan& plan = result.plan[k];
    return {{"rung", k + 1},
            {"id", kRungNames[k].id},
            {"title", kRungNames[k].title},
            {"note", plan.note},
            {"ways", {{"raster", plan.raster_method}, {"raytrace", plan.raytrace_method}}},
            {"quantities", quantities},
            {"code", code_json(static_cast<int>(k) + 1)}};
}

std::string percent(double part) {
    return fixed(std::abs(part) < 5e-5 ? 0 : 100 * part, 2) + " %"; // avoids "-0.00"
}

std::string error_text(const MeasuredQuantity& q) {
    if (q.hits) return message(q.hits->pixels - q.hits->same, " of ", q.hits->pixels);
    return significant(q.error.rmse, 4);
}

int lines_of(std::size_t k, std::string_view side) {
    int lines = 0;
    for (const CodeFile& file : code_files())
        if (file.rung == static_cast<int>(k) + 1 && file.side == side) lines += file.lines;
    return lines;
}

const std::vector<int> kRungWidths{-18, 16, 12, 12, 10, 10, 10};

/// Prints one row of the second table: a quantity, or that it is missing. Only a rung's first row has its lines
/// of code.
void print_row(std::ostream& out, std::size_t k, bool first, const MeasuredQuantity* q) {
    std::vector<std::string> cells{message("  ", k + 1, ' ', q ? q->name : kRungNames[k].id), q ? error_text(*q) : "-",
                                   q ? format_duration(q->raster.seconds) : "-",
                                   q ? format_duration(q->raytrace.seconds) : "-"};
    for (const char* const side : {"raster", "raytrace", "both"})
        if (first) cells.push_back(std::to_string(lines_of(k, side)));
    print_cells(out, kRungWidths, cells);
}

void print_rung(std::ostream& out, const LadderResult& result, std::size_t k) {
    const MeasuredRung& rung = result.rungs[k];
    if (rung.empty()) print_row(out, k, true, nullptr);
    for (const MeasuredQuantity& q : rung) print_row(out, k, &q == &rung.front(), &q);
    if (!result.plan[k].note.empty()) out << "    " << result.plan[k].note << '\n';
}

void print_shares(std::ostream& out, const LadderResult& result) {
    out << "where the difference comes from, each rung's approximation replaced in this order:\n";
    if (result.shares.negligible) {
        out << "  nowhere: the images are equal but for rounding\n";
        return;
    }
    const std::vector<int> widths{-42, 10, 14};
    print_cells(out, widths, {"  cause", "share", "largest in"});
    for (std::size_t i = 0; i < kCauseCount; ++i)
        print_cells(out, widths,
                    {(i == kNoise ? "  - " : message("  ", i + 1, ' ')) + cause_title(i),
                     percent(result.shares.share[i]), percent(result.map.pixels[i])});
    out << "  sum of shares: " << fixed(result.shares.sum, 14) << "; something to be seen in "
        << percent(result.map.visible) << " of the pixels\n";
}

} // namespace

json ladder_json(const LadderResult& result) {
    json rungs = json::array();
    for (std::size_t k = 0; k < kRungCount; ++k) rungs.push_back(rung_json(result, k));
    const auto& everything = result.rungs.back().front();
    return {{"scene", result.scene.path.string()},
            {"version", DUET_VERSION},
            {"width", result.view.width},
            {"height", result.view.height},
            {"threads", result.settings.threads > 0 ? result.settings.threads : available_threads()},
            {"seed", result.settings.seed},
            {"max_depth", result.settings.max_depth},
            {"samples_per_pixel",
             {{"raster", everything.raster.samples_per_pixel}, {"raytrace", everything.raytrace.samples_per_pixel}}},
            {"seconds", result.seconds},
            {"metrics", metrics_json(result.metrics, "raster", "raytrace")},
            {"shares", shares_json(result)},
            {"shares_sum", result.shares.negligible ? json(nullptr) : json(result.shares.sum)},
            {"difference_rms", result.shares.rms},
            {"nothing_to_explain", result.shares.negligible},
            {"visible_pixels", result.map.visible},
            {"rungs", rungs},
            {"frame", code_json(0)},
            {"invalid_samples", result.images.invalid_samples}};
}

void print_ladder(std::ostream& out, const LadderResult& result) {
    print_shares(out, result);
    out << "rung by rung, each quantity rendered by itself (of hits: pixels that differ); lines of code, shared ones "
           "last:\n";
    print_cells(out, kRungWidths, {"  quantity", "rmse", "raster", "raytrace", "raster", "raytrace", "both"});
    for (std::size_t k = 0; k < kRungCount; ++k) print_rung(out, result, k);
    if (result.images.invalid_samples > 0)
        out << result.images.invalid_samples << " samples were NaN, infinite or negative, and were dropped\n";
}

} // namespace duet::compare

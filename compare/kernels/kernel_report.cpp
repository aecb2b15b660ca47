#include "compare/kernels/kernel_report.h"

#include "common/system/error.h"
#include "compare/report/text.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

bool is_rate(const KernelRow& row) { return row.work != "build" && row.work != "memory"; }

/// Returns whether the path tracer traces such rays in this form. It traces camera rays only in batches
/// ("camera-bulk").
bool as_rendered(const KernelRow& row) { return row.work != "camera"; }

std::string figure(const KernelRow& row, double value) {
    if (row.work == "memory") return fixed(value, 1) + " B";
    if (row.work == "build") return fixed(1000 * value, 1) + " ms";
    return fixed(value, 2);
}

std::string ratio_text(const MedianRange& ratio) {
    return fixed(ratio.min, 2) + " - " + fixed(ratio.median, 2) + " - " + fixed(ratio.max, 2);
}

/// Formats a number with separators of thousands, such as "1,234,567".
std::string with_separators(std::int64_t number) {
    const std::string digits = std::to_string(number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

json range_json(const MedianRange& range) { return {{"min", range.min}, {"median", range.median}, {"max", range.max}}; }

json faults_json(const KernelErrors& faults) {
    return {{"rays", faults.rays}, {"edge_faults", faults.edge}, {"wrong", faults.wrong}};
}

json row_json(const KernelResults& table, const KernelRow& row) {
    const bool peer = !row.peer_name.empty();
    json result = {{"mesh", table.mesh},
                   {"scene", table.scene},
                   {"triangles", table.triangles},
                   {"work", row.work},
                   {"threads", row.threads},
                   {"ours", row.ours},
                   {"peer", peer ? json(row.peer) : json(nullptr)},
                   {"peer_name", peer ? json(row.peer_name) : json(nullptr)},
                   {"ratio", peer ? range_json(row.ratio) : json(nullptr)},
                   {"best", row.best},
                   {"repeats", row.repeats}};
    if (is_rate(row)) {
        result["rays"] = row.rays;
        result["as_rendered"] = as_rendered(row);
    }
    if (row.mismatches) {
        const Mismatches& m = *row.mismatches;
        result["mismatches"] = {{"rays", m.rays},
                                {"differ", m.differ()},
                                {"tie", m.tie},
                                {"edge", m.edge},
                                {"edge_fault", m.fault},
                                {"unexplained", m.unexplained},
                                {"ours_edge_faults", m.ours.edge},
                                {"peer_edge_faults", m.peer.edge},
                                {"ours_wrong", m.ours.wrong},
                                {"peer_wrong", m.peer.wrong}};
    }
    if (row.leaks)
        result["leaks"] = {{"ours", row.leaks->ours}, {"peer", peer ? json(row.leaks->peer) : json(nullptr)}};
    return result;
}

/// Returns a sort key for the number of mismatches and leaks. Unexplained mismatches come first.
std::array<std::int64_t, 4> severity(const KernelRow& row) {
    std::array<std::int64_t, 4> result{};
    if (row.mismatches) result = {row.mismatches->unexplained, row.mismatches->fault, 0, row.mismatches->differ()};
    if (row.leaks) result[2] = row.leaks->ours + row.leaks->peer;
    return result;
}

/// Returns, for each workload, the row with the largest severity(), sorted in descending order. Results do not depend
/// on the number of threads.
std::vector<const KernelRow*> rows_to_explain(const KernelResults& table) {
    std::vector<const KernelRow*> worst;
    for (const KernelRow& row : table.rows) {
        if (!row.mismatches && !row.leaks) continue;
        const auto same = std::ranges::find(worst, row.work, [](const KernelRow* r) { return r->work; });
        if (same == worst.end())
            worst.push_back(&row);
        else if (severity(row) > severity(**same))
            *same = &row;
    }
    std::ranges::stable_sort(worst,
                             [](const KernelRow* a, const KernelRow* b) { return severity(*a)[0] > severity(*b)[0]; });
    return worst;
}

void print_differences(std::ostream& out, const KernelResults& table) {
    const std::vector<const KernelRow*> rows = rows_to_explain(table);
    if (rows.empty()) return;
    const std::vector<int> widths{2, -12, 11, 8, 8, 10, 10, 11, 11, 10, 10, 2, 0};
    out << "  where both differ: ties, outlines and ends within rounding; edge faults and wrong answers of each; rays "
           "lost from the closed room\n";
    print_cells(out, widths,
                {"", "work", "rays", "ties", "edges", "our e.f.", "its e.f.", "our wrong", "its wrong", "we lose",
                 "it loses", "", "the peer's setting with the most"});
    for (const KernelRow* row : rows) {
        const Mismatches m = row->mismatches.value_or(Mismatches{});
        const Leaks leaks = row->leaks.value_or(Leaks{});
        const auto if_peer = [&](std::int64_t n) { return row->mismatches ? with_separators(n) : "-"; };
        const auto if_closed = [&](std::int64_t n) { return row->leaks ? with_separators(n) : "-"; };
        print_cells(out, widths,
                    {"", row->work + (m.unexplained > 0 ? " !" : ""), if_peer(m.rays), if_peer(m.tie), if_peer(m.edge),
                     if_peer(m.ours.edge), if_peer(m.peer.edge), if_peer(m.ours.wrong), if_peer(m.peer.wrong),
                     if_closed(leaks.ours), row->mismatches ? if_closed(leaks.peer) : "-", "", row->peer_name});
    }
}

/// Prints the checks of the results: by the oracle, against the peer's results, and for rays aimed at edges.
void print_checks(std::ostream& out, const KernelResults& table) {
    print_differences(out, table);
    KernelErrors judged;
    for (const KernelResults::CheckedWork& work : table.judged) judged += work.found;
    if (judged.rays > 0)
        out << "  " << with_separators(judged.rays)
            << " of our answers judged in double precision: " << with_separators(judged.wrong) << " wrong, "
            << with_separators(judged.edge) << " edge faults\n";
    if (table.watertight.empty()) return;
    out << "  " << with_separators(table.watertight.front().faults.rays)
        << " rays aimed at points, edges and vertices from within, each judged (lost, edge faults, wrong):\n";
    for (const KernelResults::Aimed& aimed : table.watertight)
        print_cells(out, {4, -32, 10, 10, 10},
                    {"", aimed.kernel, with_separators(aimed.misses), with_separators(aimed.faults.edge),
                     with_separators(aimed.faults.wrong)});
}

} // namespace

void mark_best(std::vector<KernelRow>& rows) {
    for (KernelRow& row : rows)
        row.best = !row.peer_name.empty() && std::ranges::none_of(rows, [&](const KernelRow& other) {
            const bool comparable = other.work == row.work && other.threads == row.threads && !other.peer_name.empty();
            return comparable && (other.ratio.median < row.ratio.median ||
                                  (&other < &row && other.ratio.median == row.ratio.median)); // the first of equal rows
        });
}

std::string verdict(const MedianRange& ratio, int repeats) {
    if (repeats < kMinRepeatsForVerdict) return "too few";
    return ratio.min > 1 ? "ahead" : ratio.max < 1 ? "behind" : "even";
}

json rows_json(const KernelResults& table) {
    json rows = json::array();
    for (const KernelRow& row : table.rows) rows.push_back(row_json(table, row));
    return rows;
}

json watertight_json(const KernelResults& table) {
    json list = json::array();
    for (const KernelResults::Aimed& aimed : table.watertight) {
        json entry = {{"mesh", table.mesh},
                      {"scene", table.scene},
                      {"triangles", table.triangles},
                      {"kernel", aimed.kernel},
                      {"misses", aimed.misses}};
        entry.update(faults_json(aimed.faults));
        list.push_back(entry);
    }
    return list;
}

json judged_json(const KernelResults& table) {
    json list = json::array();
    for (const KernelResults::CheckedWork& judged : table.judged) {
        json entry = {{"mesh", table.mesh}, {"scene", table.scene}, {"work", judged.work}};
        entry.update(faults_json(judged.found));
        list.push_back(entry);
    }
    return list;
}

void print_table(std::ostream& out, const KernelResults& table) {
    out << table.mesh << ", " << table.scene << ": " << with_separators(static_cast<std::int64_t>(table.triangles))
        << " triangles, " << table.width << "x" << table.height << " camera rays";
    if (table.omitted_spheres > 0) out << ", " << table.omitted_spheres << " spheres left out";
    out << "; million rays a second\n";
    const std::vector<int> widths{2, -12, 8, 11, 11, 2, -21, 7, 2, -9, 0};
    print_cells(
        out, widths,
        {"", "work", "threads", "ours", "peer", "", "min - median - max", "repeats", "", "ours is", "the peer's best"});
    for (const KernelRow& row : table.rows) {
        const std::string threads = row.work == "memory" ? "" : std::to_string(row.threads);
        const std::string work = row.work + (is_rate(row) && !as_rendered(row) ? " *" : "");
        const bool timed = row.work != "memory";
        const std::string repeats = timed ? std::to_string(row.repeats) : "";
        const std::string ours = figure(row, row.ours);
        if (row.peer_name.empty())
            print_cells(out, widths, {"", work, threads, ours, "-", "", "", repeats, "", "", ""});
        if (row.best)
            print_cells(out, widths,
                        {"", work, threads, ours, figure(row, row.peer), "", ratio_text(row.ratio), repeats, "",
                         timed ? verdict(row.ratio, row.repeats) : "", row.peer_name});
    }
    if (std::ranges::any_of(table.rows, [](const KernelRow& row) { return is_rate(row) && !as_rendered(row); }))
        out << "  * one by one, for comparison with other kernels: the path tracer traces camera rays in bulk\n";
    print_checks(out, table);
}

std::vector<std::string> kernel_failures(const KernelResults& table) {
    std::vector<std::string> found;
    const auto add = [&](std::int64_t count, const auto&... what) {
        if (count > 0) found.push_back(message(table.mesh, ", ", table.scene, ": ", count, what...));
    };
    for (const KernelResults::Aimed& aimed : table.watertight) {
        if (!aimed.kernel.starts_with("duet")) continue;
        add(aimed.misses, " of our rays left the closed scene (", aimed.kernel, ")");
        add(aimed.faults.edge, " of our rays slipped through edges that they were aimed at (", aimed.kernel, ")");
        add(aimed.faults.wrong, " of our answers to rays aimed at edges are wrong (", aimed.kernel, ")");
    }
    for (const KernelResults::CheckedWork& judged : table.judged) {
        add(judged.found.wrong, " of ", judged.found.rays, " of our answers to ", judged.work, " rays are wrong");
        add(judged.found.edge, " of ", judged.found.rays, " of our ", judged.work, " rays slipped through edges");
    }
    std::vector<std::string> leaked; // workloads already reported
    for (const KernelRow& row : table.rows) {
        if (row.leaks && row.leaks->ours > 0 && std::ranges::count(leaked, row.work) == 0) {
            leaked.push_back(row.work);
            add(row.leaks->ours, " of our ", row.work, " rays left the closed room");
        }
        if (!row.mismatches || row.threads != 1) continue;
        add(row.mismatches->ours.wrong, " of our answers to ", row.work, " rays are wrong (found beside ",
            row.peer_name, ")");
        add(row.mismatches->ours.edge, " of our ", row.work, " rays slipped through edges (found beside ",
            row.peer_name, ")");
    }
    return found;
}

} // namespace duet::compare

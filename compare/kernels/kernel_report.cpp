#include "compare/kernels/kernel_report.h"

#include "common/system/error.h"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

bool is_rate(const KernelRow& row) { return row.work != "build" && row.work != "memory"; }

std::string figure(const KernelRow& row, double value) {
    std::ostringstream out;
    if (row.work == "memory")
        out << std::fixed << std::setprecision(1) << value << " B";
    else if (row.work == "build")
        out << std::fixed << std::setprecision(1) << 1000 * value << " ms";
    else
        out << std::fixed << std::setprecision(2) << value;
    return out.str();
}

std::string ratio_text(const Range& ratio) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(2) << ratio.min << " - " << ratio.median << " - " << ratio.max;
    return out.str();
}

/// 1234567 as "1,234,567".
std::string grouped(std::int64_t number) {
    const std::string digits = std::to_string(number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

json range_json(const Range& range) { return {{"min", range.min}, {"median", range.median}, {"max", range.max}}; }

json row_json(const KernelTable& table, const KernelRow& row) {
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
    if (is_rate(row)) result["rays"] = row.rays;
    if (row.mismatches) {
        const Mismatches& m = *row.mismatches;
        result["mismatches"] = {{"rays", m.rays},
                                {"differ", m.differ()},
                                {"tie", m.tie},
                                {"edge", m.edge},
                                {"unexplained", m.unexplained},
                                {"ours_wrong", m.ours_wrong},
                                {"peer_wrong", m.peer_wrong}};
    }
    if (row.leaks)
        result["leaks"] = {{"ours", row.leaks->ours}, {"peer", peer ? json(row.leaks->peer) : json(nullptr)}};
    return result;
}

/// Whether the peer did better in a than in b.
bool better(const KernelRow& a, const KernelRow& b) { return is_rate(a) ? a.peer > b.peer : a.peer < b.peer; }

/// The row of most differences, or none.
const KernelRow* most_different(const KernelTable& table) {
    const KernelRow* worst = nullptr;
    for (const KernelRow& row : table.rows)
        if (row.mismatches && (worst == nullptr || row.mismatches->differ() > worst->mismatches->differ()))
            worst = &row;
    return worst;
}

/// Whether the answers are right: ours by the judge, ours beside the peer's, leaks, misses.
void print_checks(std::ostream& out, const KernelTable& table) {
    Judged judged;
    for (const KernelTable::JudgedWork& work : table.judged) {
        judged.rays += work.found.rays;
        judged.wrong += work.found.wrong;
    }
    if (judged.rays > 0)
        out << "  " << grouped(judged.rays) << " of our answers judged in double precision: " << grouped(judged.wrong)
            << " wrong\n";
    if (const KernelRow* worst = most_different(table)) {
        const Mismatches& m = *worst->mismatches;
        out << "  differences from the peer, most with " << worst->work << ", " << worst->peer_name << ": "
            << grouped(m.tie) << " ties, " << grouped(m.edge) << " at edges, " << grouped(m.unexplained)
            << " unexplained (" << grouped(m.ours_wrong) << " ours, " << grouped(m.peer_wrong) << " the peer's) of "
            << grouped(m.rays) << '\n';
    }
    std::optional<std::int64_t> peer_leaks;
    for (const KernelRow& row : table.rows)
        if (row.leaks) peer_leaks = std::max(peer_leaks.value_or(0), row.leaks->peer);
    if (peer_leaks) {
        out << "  rays lost from the closed room: ours " << grouped(table.our_leaks);
        if (most_different(table) != nullptr) out << ", the peer's at most " << grouped(*peer_leaks);
        out << '\n';
    }
    if (table.watertight.empty()) return;
    out << "  " << grouped(table.watertight.front().rays)
        << " rays aimed at points, edges and vertices from within, lost:";
    for (const KernelTable::Missed& m : table.watertight)
        out << (&m == &table.watertight.front() ? " " : ", ") << m.kernel << ' ' << grouped(m.misses);
    out << '\n';
}

} // namespace

void mark_best(std::vector<KernelRow>& rows) {
    for (KernelRow& row : rows)
        row.best = !row.peer_name.empty() && std::ranges::none_of(rows, [&](const KernelRow& other) {
            const bool rival = other.work == row.work && other.threads == row.threads && !other.peer_name.empty();
            return rival && (better(other, row) || (&other < &row && !better(row, other))); // of equals the first
        });
}

std::string verdict(const Range& ratio) { return ratio.min > 1 ? "ahead" : ratio.max < 1 ? "behind" : "even"; }

json rows_json(const KernelTable& table) {
    json rows = json::array();
    for (const KernelRow& row : table.rows) rows.push_back(row_json(table, row));
    return rows;
}

json watertight_json(const KernelTable& table) {
    json list = json::array();
    for (const KernelTable::Missed& m : table.watertight)
        list.push_back({{"mesh", table.mesh},
                        {"scene", table.scene},
                        {"triangles", table.triangles},
                        {"kernel", m.kernel},
                        {"rays", m.rays},
                        {"misses", m.misses}});
    return list;
}

json judged_json(const KernelTable& table) {
    json list = json::array();
    for (const KernelTable::JudgedWork& judged : table.judged)
        list.push_back({{"mesh", table.mesh},
                        {"scene", table.scene},
                        {"work", judged.work},
                        {"rays", judged.found.rays},
                        {"wrong", judged.found.wrong}});
    return list;
}

void print_table(std::ostream& out, const KernelTable& table) {
    out << table.mesh << ", " << table.scene << ": " << grouped(static_cast<std::int64_t>(table.triangles))
        << " triangles, " << table.width << "x" << table.height << " camera rays";
    if (table.left_out > 0) out << ", " << table.left_out << " spheres left out";
    out << "; million rays a second\n";
    const auto line = [&](const std::string& work, const std::string& threads, const std::string& ours,
                          const std::string& peer, const std::string& ratio, const std::string& verdict_text,
                          const std::string& name) {
        out << "  " << std::left << std::setw(12) << work << std::right << std::setw(8) << threads << std::setw(11)
            << ours << std::setw(11) << peer << "  " << std::left << std::setw(21) << ratio << std::setw(8)
            << verdict_text << name << '\n';
    };
    line("work", "threads", "ours", "peer", "min - median - max", "ours is", "the peer's best");
    for (const KernelRow& row : table.rows) {
        const std::string threads = row.work == "memory" ? "" : std::to_string(row.threads);
        if (row.peer_name.empty()) line(row.work, threads, figure(row, row.ours), "-", "", "", "");
        if (row.best)
            line(row.work, threads, figure(row, row.ours), figure(row, row.peer), ratio_text(row.ratio),
                 verdict(row.ratio), row.peer_name);
    }
    print_checks(out, table);
}

std::vector<std::string> faults(const KernelTable& table) {
    std::vector<std::string> found;
    const std::string where = table.mesh + ", " + table.scene + ": ";
    if (table.our_leaks > 0) found.push_back(where + message(table.our_leaks, " of our rays left the closed room"));
    if (!table.watertight.empty() && table.watertight.front().misses > 0)
        found.push_back(where + message(table.watertight.front().misses, " of our rays left the closed mesh"));
    for (const KernelTable::JudgedWork& judged : table.judged)
        if (judged.found.wrong > 0)
            found.push_back(where + message(judged.found.wrong, " of ", judged.found.rays, " of our answers to ",
                                            judged.work, " rays are wrong"));
    for (const KernelRow& row : table.rows)
        if (row.mismatches && row.mismatches->ours_wrong > 0 && row.threads == 1)
            found.push_back(where + message(row.mismatches->ours_wrong, " of our answers to ", row.work,
                                            " rays are wrong (found beside ", row.peer_name, ")"));
    return found;
}

} // namespace duet::compare

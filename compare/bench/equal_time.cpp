#include "compare/bench/equal_time.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace duet::compare {

namespace {

struct Point {
    Estimate seconds, error;
};

/// Returns the slope of the line through two points in the logarithms of both coordinates.
double log_slope(double x0, double y0, double x1, double y1) { return std::log(y1 / y0) / std::log(x1 / x0); }

/// Interpolates between two measurements, linearly in the logarithms of time and error.
Estimate interpolate(const Point& a, const Point& b, double seconds) {
    const double slope = log_slope(a.seconds.value, a.error.value, b.seconds.value, b.error.value);
    const auto uncertainty = [&](const Point& p) {
        return std::hypot(p.error.relative_error, slope * p.seconds.relative_error);
    };
    return {a.error.value * std::pow(seconds / a.seconds.value, slope), std::max(uncertainty(a), uncertainty(b)),
            std::min(std::min(a.error.dof, b.error.dof), std::min(a.seconds.dof, b.seconds.dof))};
}

} // namespace

std::optional<Estimate> error_at(const std::vector<Measurement>& rows, const std::string& technique,
                                 const std::optional<std::string>& sampler, double seconds, bool rest) {
    std::vector<Point> points;
    for (const Measurement& m : rows) {
        if (m.technique != technique || (sampler && m.sampler != *sampler) || !m.counted) continue;
        const Estimate& error = rest ? m.rest_mse : m.mse;
        if (error.value > 0 && m.seconds.value > 0) points.push_back({m.seconds, error});
    }
    const auto time = [](const Point& p) { return p.seconds.value; };
    std::ranges::sort(points, {}, time);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Point &a = points[i], &b = points[i + 1];
        if (seconds >= time(a) && seconds <= time(b) && time(a) < time(b)) return interpolate(a, b, seconds);
    }
    return std::nullopt;
}

std::vector<EqualTimeRow> at_equal_times(const std::vector<Measurement>& rows,
                                         const std::vector<double>& equal_times_seconds, const std::string& peer) {
    std::vector<EqualTimeRow> table;
    for (const double seconds : equal_times_seconds) {
        const auto ratio = [&](const std::optional<Estimate>& error, bool rest) -> std::optional<Estimate> {
            const auto peer_error = peer.empty() ? std::nullopt : error_at(rows, peer, std::nullopt, seconds, rest);
            return error && peer_error ? std::optional(ratio_of(*error, *peer_error)) : std::nullopt;
        };
        std::set<std::string> seen;
        for (const Measurement& m : rows) {
            const bool is_peer = m.technique == peer;
            const std::string name = is_peer ? m.technique : m.name();
            if (!seen.insert(name).second) continue;
            const std::optional<std::string> sampler = is_peer ? std::nullopt : std::optional(m.sampler);
            EqualTimeRow row{seconds,
                             name,
                             error_at(rows, m.technique, sampler, seconds, false),
                             error_at(rows, m.technique, sampler, seconds, true),
                             {},
                             {}};
            if (!is_peer) {
                row.to_peer = ratio(row.mse, false);
                row.rest_to_peer = ratio(row.rest_mse, true);
            }
            table.push_back(std::move(row));
        }
    }
    return table;
}

namespace {

/// Returns the time in which `path` with one sampler reaches an error. `rows` are sorted by decreasing error.
Dominance time_to_reach(double relmse, const std::vector<const Measurement*>& rows) {
    const auto estimate = [](double seconds, const Measurement& m) {
        // The error of an unbiased estimate falls as 1 / time. The relative errors of error and time therefore have the
        // same weight.
        return Estimate{seconds, std::hypot(m.relmse.relative_error, m.seconds.relative_error),
                        std::min(m.relmse.dof, m.seconds.dof)};
    };
    if (relmse >= rows.front()->relmse.value) return {rows.front()->seconds, true};
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
        const Measurement &a = *rows[i], &b = *rows[i + 1];
        if (relmse < b.relmse.value) continue;
        const double slope = log_slope(a.relmse.value, a.seconds.value, b.relmse.value, b.seconds.value);
        return {estimate(a.seconds.value * std::pow(relmse / a.relmse.value, slope), b), false};
    }
    const Measurement& last = *rows.back();
    return {estimate(last.seconds.value * last.relmse.value / relmse, last), false};
}

} // namespace

std::optional<Dominance> dominance(const std::vector<Measurement>& rows, const Measurement& row) {
    if (row.technique == "path" || !(row.relmse.value > 0) || !(row.seconds.value > 0)) return std::nullopt;
    std::map<std::string, std::vector<const Measurement*>> samplers;
    for (const Measurement& m : rows)
        if (m.technique == "path" && m.relmse.value > 0 && m.seconds.value > 0) samplers[m.sampler].push_back(&m);
    std::optional<Dominance> fastest;
    for (auto& [sampler, measured] : samplers) {
        std::sort(measured.begin(), measured.end(),
                  [](const Measurement* a, const Measurement* b) { return a->relmse.value > b->relmse.value; });
        Dominance time = time_to_reach(row.relmse.value, measured);
        if (!fastest || time.ratio.value < fastest->ratio.value) fastest = time;
    }
    if (!fastest) return std::nullopt;
    fastest->ratio.relative_error = std::hypot(fastest->ratio.relative_error, row.relmse.relative_error);
    return Dominance{ratio_of(fastest->ratio, row.seconds), fastest->at_most};
}

} // namespace duet::compare

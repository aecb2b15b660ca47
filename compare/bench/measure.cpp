#include "compare/bench/measure.h"

#include "common/sampling/hash.h"
#include "common/system/stopwatch.h"
#include "compare/metrics/error_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace duet::compare {

namespace {

/// A RunningMeasurement is a measurement in progress.
struct RunningMeasurement {
    const BenchRenderer* renderer = nullptr;
    Measurement measurement;
    ImageRgb last; ///< the previous seed's image; half the squared difference of two estimates estimates the variance
    double squared_differences = 0;
};

std::vector<RunningMeasurement> start_measurements(const std::vector<BenchRenderer>& renderers) {
    std::vector<RunningMeasurement> list;
    for (const BenchRenderer& c : renderers)
        for (const int spp : c.spps) {
            RunningMeasurement running{&c, {}, {}, 0};
            running.measurement.technique = c.technique;
            running.measurement.sampler = c.sampler;
            running.measurement.note = c.note;
            running.measurement.spp = spp;
            list.push_back(std::move(running));
        }
    return list;
}

double mean_squared_difference(const ImageRgb& a, const ImageRgb& b) {
    return image_error(a, b, Image<std::uint8_t>(a.width(), a.height(), 1)).mse;
}

/// Renders once and records the errors. Returns false if stopped.
bool run_trial(RunningMeasurement& running, std::uint64_t seed, const Reference& reference,
               const Image<std::uint8_t>& counted, Control& control) {
    TimedImage trial = running.renderer->render(running.measurement.spp, seed, control);
    if (control.stopped()) return false;
    const Image<std::uint8_t> all(counted.width(), counted.height(), 1);
    running.measurement.trials.push_back({seed, trial.seconds, trial.cpu_seconds,
                                          image_error(trial.image, reference.mean, all),
                                          image_error(trial.image, reference.mean, counted)});
    if (!running.last.empty()) running.squared_differences += mean_squared_difference(trial.image, running.last);
    running.last = std::move(trial.image);
    return true;
}

template <typename Figure> Estimate mean_over(const std::vector<TrialResult>& trials, Figure figure) {
    std::vector<double> values;
    for (const TrialResult& t : trials) values.push_back(figure(t));
    return mean_of(values);
}

Measurement finish(RunningMeasurement& running, double reference_error) {
    Measurement m = std::move(running.measurement);
    std::vector<double> seconds;
    for (const TrialResult& t : m.trials) seconds.push_back(t.seconds);
    const double pairs = static_cast<double>(m.trials.size()) - 1;
    m.variance = pairs > 0 ? running.squared_differences / (2 * pairs) : std::numeric_limits<double>::quiet_NaN();
    m.mse = mean_over(m.trials, [](const TrialResult& t) { return t.whole.mse; });
    m.relmse = mean_over(m.trials, [](const TrialResult& t) { return t.whole.relmse; });
    m.rest_mse = mean_over(m.trials, [](const TrialResult& t) { return t.rest.mse; });
    m.rest_relmse = mean_over(m.trials, [](const TrialResult& t) { return t.rest.relmse; });
    m.seconds = median_of(std::move(seconds));
    m.efficiency = efficiency_of(m.mse, m.seconds);
    m.relmse_efficiency = efficiency_of(m.relmse, m.seconds);
    m.rest_efficiency = efficiency_of(m.rest_mse, m.seconds);
    m.rest_relmse_efficiency = efficiency_of(m.rest_relmse, m.seconds);
    m.reference_share = m.mse.value > 0 ? reference_error / m.mse.value : 0;
    return m;
}

} // namespace

double Measurement::bias_share() const {
    const double explained = variance + reference_share * mse.value;
    return explained < mse.low() ? 1 - explained / mse.value : 0; // a NaN variance (one trial) yields 0
}

void mark_best_settings(std::vector<Measurement>& rows, const std::string& technique) {
    for (Measurement& a : rows)
        if (a.technique == technique)
            a.counted = std::none_of(rows.begin(), rows.end(), [&](const Measurement& b) {
                return b.technique == technique && b.spp == a.spp && b.efficiency.value > a.efficiency.value;
            });
}

void widen_efficiency(std::vector<Measurement>& rows, double drift, double share) {
    const double log_lost_share = share > 0 && share < 1 ? -std::log(share) : 0;
    constexpr double kManyDegrees = 1e6; // degrees of freedom of a value that is assumed, not estimated
    const Estimate clock_speed{1, std::hypot(std::log1p(drift), log_lost_share) / 2, kManyDegrees};
    for (Measurement& m : rows)
        for (Estimate* const efficiency :
             {&m.efficiency, &m.relmse_efficiency, &m.rest_efficiency, &m.rest_relmse_efficiency})
            *efficiency = ratio_of(*efficiency, clock_speed);
}

double processor_share(const std::vector<Measurement>& rows, int threads) {
    double wall = 0, processor = 0;
    for (const Measurement& m : rows)
        for (const TrialResult& t : m.trials) {
            if (t.seconds < 0.01 || t.cpu_seconds <= 0) continue;
            wall += t.seconds;
            processor += t.cpu_seconds;
        }
    return wall > 0 ? processor / (wall * threads) : 1;
}

ImageError image_error(const ImageRgb& image, const ImageRgb& reference, const Image<std::uint8_t>& counted) {
    DUET_CHECK_EQ(image.size(), reference.size());
    DUET_CHECK_EQ(image.size(), counted.size());
    ImageError total;
    double pixels = 0;
    for (int y = 0; y < image.height(); ++y) {
        ImageError row; // summed per row first, because the rounding error of a sum grows with its length
        for (int x = 0; x < image.width(); ++x) {
            if (counted(x, y) == 0) continue;
            ++pixels;
            for (std::size_t c = 0; c < 3; ++c) {
                const double r = static_cast<double>(reference(x, y)[c]);
                const double square = sqr(static_cast<double>(image(x, y)[c]) - r);
                row.mse += square;
                row.relmse += relative_square(square, r);
            }
        }
        total.mse += row.mse;
        total.relmse += row.relmse;
    }
    return {total.mse / (3 * pixels), total.relmse / (3 * pixels)};
}

std::vector<Measurement> measure(const std::vector<BenchRenderer>& renderers, const Reference& reference,
                                 const Image<std::uint8_t>& counted, const BenchMeasureSettings& settings,
                                 Control& control) {
    Control quiet{control.stop, {}};
    for (const BenchRenderer& c : renderers) c.render(1, settings.seed, quiet); // warms up caches and CPU clocks

    std::vector<RunningMeasurement> running = start_measurements(renderers);
    const auto count = static_cast<std::uint32_t>(running.size());
    double round_work = 0, done = 0;
    for (const RunningMeasurement& r : running) round_work += r.measurement.spp;
    const Stopwatch watch;
    for (int round = 0; round < settings.repeats; ++round) {
        if (round >= 2 && watch.seconds() > settings.time_limit) break;
        for (std::uint32_t i = 0; i < count; ++i) {
            RunningMeasurement& next = running[permute(i, count, hash_combine(0, static_cast<std::uint64_t>(round)))];
            const std::uint64_t seed = settings.seed + 1 + static_cast<std::uint64_t>(round);
            if (!run_trial(next, seed, reference, counted, quiet)) return {};
            done += next.measurement.spp;
            control.report(
                std::max(done / (round_work * settings.repeats), std::min(watch.seconds() / settings.time_limit, 1.0)));
        }
    }
    const double reference_error = reference.mse();
    std::vector<Measurement> results;
    for (RunningMeasurement& r : running) results.push_back(finish(r, reference_error));
    return results;
}

} // namespace duet::compare

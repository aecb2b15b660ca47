#include "raytrace/render.h"
#include "compare/stop/measure_stop.h"

#include "common/system/stopwatch.h"
#include "compare/bench/measure.h"
#include "compare/metrics/error_metrics.h"
#include "compare/timing.h"
#include "raytrace/sample_schedule.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

// This is the first seed of the trials, far from the references' seeds.
constexpr std::uint64_t kFirstSeed = 1;

double own_relmse(const Reference& reference) {
    double sum = 0;
    for (std::size_t i = 0; i < reference.mean.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            sum += relative_square(static_cast<double>(reference.variance[i][c]),
                                   static_cast<double>(reference.mean[i][c]));
    return sum / (3.0 * static_cast<double>(reference.mean.size()));
}

/// Renders one scene and measures the errors.
class Trials {
public:
    Trials(const Scene& scene, const View& view, const Reference& reference, const StopSettings& settings)
        : view_(view), reference_(reference), own_mse_(reference.mse()), own_relmse_(own_relmse(reference)),
          all_(view.width, view.height, 1) {
        base_.threads = settings.threads;
        base_.samples_per_pixel = 1 << 24;
        prepared_.emplace(raytrace::prepare(scene, base_));
    }

    StopTrial run_to_error(double error, std::uint64_t seed, Control& control) {
        StopTrial trial;
        trial.seed = seed;
        raytrace::PathTracerSettings adaptive = base_;
        adaptive.seed = seed;
        adaptive.error_limit = error;
        adaptive.adaptive = true;
        adaptive.aovs.samples = true;
        const auto [rendering, seconds] = rendered(adaptive, control);
        trial.seconds = seconds;
        trial.estimated_relmse = rendering.statistics.estimated_relmse;
        trial.samples = mean_samples(rendering);
        set_errors(rendering.radiance, trial.relmse, trial.mse);
        if (control.stopped()) return trial;

        raytrace::PathTracerSettings uniform_settings = base_;
        uniform_settings.seed = seed;
        uniform_settings.samples_per_pixel = std::max(1, static_cast<int>(std::lround(trial.samples)));
        const auto [uniform, uniform_seconds] = rendered(uniform_settings, control);
        trial.uniform_seconds = uniform_seconds;
        set_errors(uniform.radiance, trial.uniform_relmse, trial.uniform_mse);
        return trial;
    }

    TimeTrial run_to_time(double time, std::uint64_t seed, Control& control) {
        raytrace::PathTracerSettings limited = base_;
        limited.seed = seed;
        limited.time_limit = time;
        limited.adaptive = true;
        limited.aovs.samples = true;
        const auto [rendering, seconds] = rendered(limited, control);
        return {seconds, seconds * std::min(1.0, 2 / mean_samples(rendering))};
    }

private:
    std::pair<Rendering, double> rendered(const raytrace::PathTracerSettings& settings, Control& control) {
        const Stopwatch watch;
        Control silent{control.stop, {}};
        Rendering rendering = raytrace::render(*prepared_, view_, settings, silent);
        return {std::move(rendering), watch.seconds()};
    }
    static double mean_samples(const Rendering& rendering) {
        double sum = 0;
        for (const std::uint32_t n : rendering.samples) sum += n;
        return sum / static_cast<double>(rendering.samples.size());
    }
    void set_errors(const ImageRgb& image, double& relmse, double& mse) const {
        const ImageError error = image_error(image, reference_.mean, all_);
        relmse = error.relmse - own_relmse_;
        mse = error.mse - own_mse_;
    }

    const View& view_;
    const Reference& reference_;
    double own_mse_, own_relmse_;
    Image<std::uint8_t> all_;
    raytrace::PathTracerSettings base_;
    std::optional<raytrace::PathTracerScene> prepared_;
};

double mean(const std::vector<StopTrial>& trials, double StopTrial::*figure) {
    double sum = 0;
    for (const StopTrial& trial : trials) sum += trial.*figure;
    return trials.empty() ? 0 : sum / static_cast<double>(trials.size());
}

/// Returns the ratio of adaptive to uniform sampling in squared error × seconds.
double cost_ratio(const std::vector<StopTrial>& trials, double StopTrial::*adaptive, double StopTrial::*uniform) {
    return mean(trials, adaptive) * mean(trials, &StopTrial::seconds) /
           (mean(trials, uniform) * mean(trials, &StopTrial::uniform_seconds));
}

} // namespace

double StopResult::median_error() const {
    std::vector<double> errors;
    for (const StopTrial& trial : trials) errors.push_back(trial.relmse);
    return median(std::move(errors));
}

double StopResult::mean_samples() const { return mean(trials, &StopTrial::samples); }

bool StopResult::stopped_at_minimum() const {
    const auto least = std::count_if(trials.begin(), trials.end(),
                                     [](const StopTrial& t) { return t.samples <= raytrace::kMinSamplesForError; });
    return 2 * static_cast<std::size_t>(least) >= trials.size();
}

double StopResult::cost_ratio_relmse() const {
    return cost_ratio(trials, &StopTrial::relmse, &StopTrial::uniform_relmse);
}

double StopResult::cost_ratio_mse() const { return cost_ratio(trials, &StopTrial::mse, &StopTrial::uniform_mse); }

bool has_caustics(const Scene& scene) { return scene.needs.specular && !scene.lights.empty(); }

std::optional<StopResult> measure_stop(const Scene& scene, const View& view, const Reference& reference,
                                       const StopSettings& settings, Control& control) {
    StopResult result;
    result.caustics = has_caustics(scene);
    Trials trials(scene, view, reference, settings);
    const int all = settings.seeds * (settings.time > 0 ? 2 : 1);
    int done = 0;
    const auto next = [&] {
        control.report(static_cast<double>(++done) / all);
        return !control.stopped();
    };
    for (int i = 0; i < settings.seeds; ++i) {
        const std::uint64_t seed = kFirstSeed + static_cast<std::uint64_t>(i);
        result.trials.push_back(trials.run_to_error(settings.error, seed, control));
        if (!next()) return std::nullopt;
        if (settings.time <= 0) continue;
        result.times.push_back(trials.run_to_time(settings.time, seed, control));
        if (!next()) return std::nullopt;
    }
    return result;
}

} // namespace duet::compare

#include "raytrace/roulette.h"

#include "raytrace/integrator/path_contributions.h"
#include "raytrace/render_pass.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace duet::raytrace {

namespace {

constexpr int kSamples = 16;                                            // samples per pixel, in two replicates
constexpr std::size_t kMaxPixels = 2048 / kSamples, kMinPixels = 512 / kSamples;
constexpr std::uint64_t kSeed = 0x70756c6c; // a seed of its own, so that no render reuses its samples
constexpr int kOctaves = 4, kStepsPerOctave = 3; // octaves of the factor from 1 on, and steps per octave

// Records the paths of one pixel.
struct PixelRecord {
    std::vector<PathStep> steps;
    std::array<std::size_t, kSamples> ends{}; // ends of the paths' steps
    double camera_rays = 0;
    double mean = 0, variance = 0; // of one sample; the variance takes stratification into account
    double importance = 0;         // weight of its squared error
};

PixelRecord trace_pixel(const RenderPlan& plan, const CameraModel& camera, int x, int y) {
    PixelRecord pixel;
    Sampler sampler(SamplerKind::kSobol, kSeed + 1, kSamples, 2);
    std::array<double, 2> sums{};
    for (std::size_t i = 0; i < kSamples; ++i) {
        sampler.start(x, y, static_cast<std::uint32_t>(i));
        const Ray ray = camera_ray(plan, camera, x, y, sampler);
        PathContributions path;
        record_path_contributions(plan, ray, plan.prepared.accelerator.closest(ray), sampler, path);
        sums[sampler.replicate()] += path.light();
        pixel.camera_rays += path.camera_rays();
        pixel.steps.insert(pixel.steps.end(), path.steps().begin(), path.steps().end());
        pixel.ends[i] = pixel.steps.size();
    }
    pixel.mean = (sums[0] + sums[1]) / kSamples;
    pixel.variance = sqr(sums[0] - sums[1]) / kSamples;
    return pixel;
}

struct ErrorTimesCost {
    double error = 0, cost = 0;

    ErrorTimesCost& operator+=(const ErrorTimesCost& other) {
        error += other.error, cost += other.cost;
        return *this;
    }
    double log() const { return std::log(error) + std::log(cost); }
};

// Returns the error and the cost of a pixel if roulette used this factor.
ErrorTimesCost error_and_cost(const PixelRecord& pixel, double survival_factor) {
    ErrorTimesCost sum{kSamples * pixel.importance * pixel.variance, pixel.camera_rays};
    std::size_t k = 0;
    for (const std::size_t end : pixel.ends) {
        double probability = 1; // probability that the path gets here
        for (; k < end; ++k) {
            const PathStep& step = pixel.steps[k];
            const double before = probability, weight = static_cast<double>(step.weight);
            if (!step.first)
                probability *= std::min(1.0, static_cast<double>(step.throughput) / probability * survival_factor);
            sum.error +=
                weight * pixel.importance * sqr(static_cast<double>(step.light)) * (1 / probability - 1 / before);
            sum.cost += weight * probability * static_cast<double>(step.next_rays);
        }
    }
    return sum;
}

// Traces the pixels of a trial, in groups. The differences between the groups show how certain the result of all of
// them is.
class TrialPaths {
public:
    TrialPaths(const RenderPlan& plan, const View& view, std::size_t count, int threads) : pixels_(count) {
        const CameraModel camera(view);
        parallel_for(count, threads, [&](std::size_t i) {
            Sampler pixel_sampler(SamplerKind::kSobol, kSeed, static_cast<int>(count));
            pixel_sampler.start(0, 0, static_cast<std::uint32_t>(i));
            const Vec2 u = pixel_sampler.get_2d();
            pixels_[i] = trace_pixel(plan, camera, static_cast<int>(u.x * static_cast<float>(view.width)),
                                     static_cast<int>(u.y * static_cast<float>(view.height)));
        });
        set_importance();
    }

    // Returns whether the trial has any variance to learn from.
    bool has_variance() const { return absolute_ > 0 && std::isfinite(absolute_); }

    using Groups = std::array<ErrorTimesCost, 16>;
    Groups evaluate(double survival_factor) const {
        Groups groups;
        for (std::size_t i = 0; i < pixels_.size(); ++i)
            groups[i % groups.size()] += error_and_cost(pixels_[i], survival_factor);
        return groups;
    }

private:
    // Sets the importance of all pixels so that the mean of importance × variance is 1. The error that roulette adds
    // is relative to that.
    void set_importance() {
        double relative = 0;
        const auto count = static_cast<double>(pixels_.size());
        for (const PixelRecord& pixel : pixels_) {
            absolute_ += pixel.variance / count;
            relative += pixel.variance / (sqr(pixel.mean) + 0.01) / count;
        }
        if (!has_variance()) return;
        for (PixelRecord& pixel : pixels_)
            pixel.importance = (1 / absolute_ + 1 / (relative * (sqr(pixel.mean) + 0.01))) / 2;
    }

    std::vector<PixelRecord> pixels_;
    double absolute_ = 0;
};

// Returns the logarithm of error × cost relative to `reference`, plus two standard errors, by the jackknife, which
// leaves out one group at a time (Efron and Tibshirani 1993, "An Introduction to the Bootstrap", §11).
double loss_upper_bound(const TrialPaths::Groups& groups, const TrialPaths::Groups& reference) {
    const auto loss = [&](std::size_t left_out) {
        ErrorTimesCost one, other;
        for (std::size_t g = 0; g < groups.size(); ++g)
            if (g != left_out) one += groups[g], other += reference[g];
        return one.log() - other.log();
    };
    const auto count = static_cast<double>(groups.size());
    double sum = 0, squares = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const double one = loss(g);
        sum += one, squares += sqr(one);
    }
    const double variance = (squares - sqr(sum) / count) * (count - 1) / count;
    return loss(groups.size()) + 2 * std::sqrt(std::max(variance, 0.0));
}

} // namespace

float estimate_survival_factor(const PathTracerSceneData& prepared, const View& view,
                               const PathTracerSettings& settings) {
    const std::size_t pixels =
        static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height) / (8 * kSamples);
    if (pixels < kMinPixels) return kDefaultSurvivalFactor;
    PathTracerSettings trial = settings;
    trial.skips = {};
    const RenderPlan plan(prepared, view, trial, std::exp2(float{kOctaves}));
    const TrialPaths trial_paths(plan, view, std::min(pixels, kMaxPixels), settings.threads);
    if (!trial_paths.has_variance()) return kDefaultSurvivalFactor;
    const TrialPaths::Groups baseline = trial_paths.evaluate(kDefaultSurvivalFactor);
    float best = kDefaultSurvivalFactor;
    double best_loss = 0;
    for (int i = 0; i <= kOctaves * kStepsPerOctave; ++i) {
        const float survival_factor = std::exp2(static_cast<float>(i) / kStepsPerOctave);
        const double loss = loss_upper_bound(trial_paths.evaluate(static_cast<double>(survival_factor)), baseline);
        if (!(loss < best_loss)) continue;
        best_loss = loss;
        best = survival_factor;
    }
    return best;
}

} // namespace duet::raytrace

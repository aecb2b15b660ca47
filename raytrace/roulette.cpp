#include "raytrace/roulette.h"

#include "raytrace/integrator/path_gains.h"
#include "raytrace/pass.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace duet::raytrace {

namespace {

constexpr int kSamples = 16;                                            // samples per pixel, in two replicates
constexpr std::size_t kMostPixels = 2048 / kSamples, kFewestPixels = 512 / kSamples;
constexpr std::uint64_t kSeed = 0x70756c6c; // a seed of its own, so that no render reuses its samples
constexpr int kOctaves = 4, kSteps = 3; // octaves of the factor from 1 on, and steps per octave

// Records the paths of one pixel.
struct Pixel {
    std::vector<PathStep> steps;
    std::array<std::size_t, kSamples> ends{}; // ends of the paths' steps
    double camera_rays = 0;
    double mean = 0, variance = 0; // of one sample; the variance takes stratification into account
    double importance = 0;         // weight of its squared error
};

Pixel traced_pixel(const RenderPlan& plan, const CameraModel& camera, int x, int y) {
    Pixel pixel;
    Sampler sampler(SamplerKind::kSobol, kSeed + 1, kSamples, 2);
    std::array<double, 2> sums{};
    for (std::size_t i = 0; i < kSamples; ++i) {
        sampler.start(x, y, static_cast<std::uint32_t>(i));
        const Ray ray = camera_ray(plan, camera, x, y, sampler);
        PathGains path;
        follow_path(plan, ray, plan.prepared.accelerator.closest(ray), sampler, path);
        sums[sampler.replicate()] += path.light();
        pixel.camera_rays += path.camera_rays();
        pixel.steps.insert(pixel.steps.end(), path.steps().begin(), path.steps().end());
        pixel.ends[i] = pixel.steps.size();
    }
    pixel.mean = (sums[0] + sums[1]) / kSamples;
    pixel.variance = sqr(sums[0] - sums[1]) / kSamples;
    return pixel;
}

struct Product {
    double error = 0, cost = 0;

    Product& operator+=(const Product& other) {
        error += other.error, cost += other.cost;
        return *this;
    }
    double log() const { return std::log(error) + std::log(cost); }
};

// Returns the error and the cost of a pixel if roulette used this factor.
Product error_and_cost(const Pixel& pixel, double worth) {
    Product sum{kSamples * pixel.importance * pixel.variance, pixel.camera_rays};
    std::size_t k = 0;
    for (const std::size_t end : pixel.ends) {
        double chance = 1; // probability that the path gets here
        for (; k < end; ++k) {
            const PathStep& step = pixel.steps[k];
            const double before = chance, weight = static_cast<double>(step.weight);
            if (!step.first) chance *= std::min(1.0, static_cast<double>(step.throughput) / chance * worth);
            sum.error += weight * pixel.importance * sqr(static_cast<double>(step.light)) * (1 / chance - 1 / before);
            sum.cost += weight * chance * static_cast<double>(step.next_rays);
        }
    }
    return sum;
}

// Traces the pixels of a trial, in groups. The differences between the groups show how certain the result of all of
// them is.
class Trials {
public:
    Trials(const RenderPlan& plan, const View& view, std::size_t count, int threads) : pixels_(count) {
        const CameraModel camera(view);
        parallel_for(count, threads, [&](std::size_t i) {
            Sampler places(SamplerKind::kSobol, kSeed, static_cast<int>(count));
            places.start(0, 0, static_cast<std::uint32_t>(i));
            const Vec2 u = places.get_2d();
            pixels_[i] = traced_pixel(plan, camera, static_cast<int>(u.x * static_cast<float>(view.width)),
                                      static_cast<int>(u.y * static_cast<float>(view.height)));
        });
        weigh();
    }

    // Returns whether the trial has any variance to learn from.
    bool tell() const { return absolute_ > 0 && std::isfinite(absolute_); }

    using Groups = std::array<Product, 16>;
    Groups with(double worth) const {
        Groups groups;
        for (std::size_t i = 0; i < pixels_.size(); ++i) groups[i % groups.size()] += error_and_cost(pixels_[i], worth);
        return groups;
    }

private:
    // Sets the importance of all pixels so that the mean of importance × variance is 1. The error that roulette adds
    // is relative to that.
    void weigh() {
        double relative = 0;
        const auto count = static_cast<double>(pixels_.size());
        for (const Pixel& pixel : pixels_) {
            absolute_ += pixel.variance / count;
            relative += pixel.variance / (sqr(pixel.mean) + 0.01) / count;
        }
        if (!tell()) return;
        for (Pixel& pixel : pixels_)
            pixel.importance = (1 / absolute_ + 1 / (relative * (sqr(pixel.mean) + 0.01))) / 2;
    }

    std::vector<Pixel> pixels_;
    double absolute_ = 0;
};

// Returns the logarithm of error × cost relative to `otherwise`, plus two standard errors, by the jackknife, which
// leaves out one group at a time (Efron and Tibshirani 1993, "An Introduction to the Bootstrap", §11).
double certain_loss(const Trials::Groups& groups, const Trials::Groups& otherwise) {
    const auto loss = [&](std::size_t left_out) {
        Product one, other;
        for (std::size_t g = 0; g < groups.size(); ++g)
            if (g != left_out) one += groups[g], other += otherwise[g];
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

float learned_worth(const PreparedData& prepared, const View& view, const Settings& settings) {
    const std::size_t pixels =
        static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height) / (8 * kSamples);
    if (pixels < kFewestPixels) return kPlainWorth;
    Settings trial = settings;
    trial.skips = {};
    const RenderPlan plan(prepared, view, trial, std::exp2(float{kOctaves}));
    const Trials trials(plan, view, std::min(pixels, kMostPixels), settings.threads);
    if (!trials.tell()) return kPlainWorth;
    const Trials::Groups plain = trials.with(kPlainWorth);
    float best = kPlainWorth;
    double least = 0;
    for (int i = 0; i <= kOctaves * kSteps; ++i) {
        const float worth = std::exp2(static_cast<float>(i) / kSteps);
        const double loss = certain_loss(trials.with(static_cast<double>(worth)), plain);
        if (!(loss < least)) continue;
        least = loss;
        best = worth;
    }
    return best;
}

} // namespace duet::raytrace

#include "raytrace/roulette.h"

#include "raytrace/integrator/path_gains.h"
#include "raytrace/pass.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace duet::raytrace {

namespace {

constexpr float kLeastWorth = 1, kMostWorth = 16;
constexpr int kSamples = 16;                       // of a pixel, in two replicates
constexpr int kMostPixels = 2048 / kSamples, kFewestPixels = 512 / kSamples;
constexpr std::uint64_t kSeed = 0x70756c6c;        // of its own: no render's samples are used twice

struct Path {
    std::size_t end = 0;  // of its steps
    double importance = 0; // of its light's square
};

// What the paths of some pixels were like.
class Trials {
public:
    Trials(const RenderPlan& plan, const View& view, int pixels) {
        const CameraModel camera(view);
        Sampler places(SamplerKind::kSobol, kSeed, pixels), sampler(SamplerKind::kSobol, kSeed + 1, kSamples, 2);
        for (int i = 0; i < pixels; ++i) {
            places.start(0, 0, static_cast<std::uint32_t>(i));
            const Vec2 u = places.get_2d();
            add_pixel(plan, camera, static_cast<int>(u.x * static_cast<float>(view.width)),
                      static_cast<int>(u.y * static_cast<float>(view.height)), sampler);
        }
        weigh();
    }

    // Whether there is anything to learn from.
    bool tell() const { return !steps_.empty() && absolute_ > 0 && std::isfinite(absolute_); }

    // Of a render with this worth, up to a factor.
    double error_times_cost(double worth) const {
        const auto count = static_cast<double>(paths_.size());
        double error = count, cost = camera_rays_;
        std::size_t k = 0;
        for (const Path& path : paths_) {
            double chance = 1; // of the path to get here
            for (; k < path.end; ++k) {
                const PathStep& step = steps_[k];
                const double before = chance, weight = static_cast<double>(step.weight);
                if (!step.first) chance *= std::min(1.0, static_cast<double>(step.throughput) / chance * worth);
                error += weight * path.importance * sqr(static_cast<double>(step.light)) * (1 / chance - 1 / before);
                cost += weight * chance * static_cast<double>(step.next_rays);
            }
        }
        return error * cost;
    }

private:
    struct Pixel {
        double mean, variance; // of one sample, as well placed as they are
    };

    void add_pixel(const RenderPlan& plan, const CameraModel& camera, int x, int y, Sampler& sampler) {
        double sums[2] = {0, 0};
        for (int i = 0; i < kSamples; ++i) {
            sampler.start(x, y, static_cast<std::uint32_t>(i));
            const Ray ray = camera_ray(plan, camera, x, y, sampler);
            PathGains path;
            follow_path(plan, ray, plan.prepared.accelerator.closest(ray), sampler, path);
            sums[sampler.replicate()] += path.light();
            camera_rays_ += path.camera_rays();
            steps_.insert(steps_.end(), path.steps().begin(), path.steps().end());
            paths_.push_back({steps_.size()});
        }
        pixels_.push_back({(sums[0] + sums[1]) / kSamples, sqr(sums[0] - sums[1]) / kSamples});
    }

    // So that the importance × variance of all pixels, beside which roulette's own is seen, is 1 in the mean.
    void weigh() {
        double relative = 0;
        for (const Pixel& pixel : pixels_) {
            absolute_ += pixel.variance / static_cast<double>(pixels_.size());
            relative += pixel.variance / (sqr(pixel.mean) + 0.01) / static_cast<double>(pixels_.size());
        }
        if (!tell()) return;
        for (std::size_t i = 0; i < paths_.size(); ++i)
            paths_[i].importance =
                (1 / absolute_ + 1 / (relative * (sqr(pixels_[i / kSamples].mean) + 0.01))) / 2;
    }

    std::vector<PathStep> steps_;
    std::vector<Path> paths_;
    std::vector<Pixel> pixels_;
    double camera_rays_ = 0, absolute_ = 0;
};

} // namespace

float learned_worth(RenderPlan& plan, const View& view) {
    const std::int64_t pixels = std::int64_t{view.width} * view.height / (4 * kSamples);
    if (pixels < kFewestPixels) return kPlainWorth;
    plan.worth = kMostWorth;
    const Trials trials(plan, view, static_cast<int>(std::min<std::int64_t>(pixels, kMostPixels)));
    if (!trials.tell()) return kPlainWorth;
    float best = kPlainWorth;
    double least = trials.error_times_cost(kPlainWorth);
    for (float worth = kLeastWorth; worth <= kMostWorth; worth *= 1.25f) {
        const double product = trials.error_times_cost(worth);
        if (!(product < least)) continue;
        least = product;
        best = worth;
    }
    return best;
}

} // namespace duet::raytrace

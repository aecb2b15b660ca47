#include "raytrace/bidirectional/metropolis.h"

#include "common/sampling/hash.h"
#include "raytrace/bidirectional/run_in_order.h"
#include "raytrace/sampling/primary_sample.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace duet::raytrace {

namespace {

constexpr std::size_t kStepsPerChain = 128;
constexpr std::size_t kRowsInGroup = 64, kChainsInGroup = 1024; ///< splats of this many are stored at a time
constexpr int kMaxTiles = 16;                                   ///< tiles of the pilot along each axis, at most
constexpr double kPathsPerTile = 64;                            ///< paths of the pilot per tile, at least
constexpr int kPilotPaths = 16384;                              ///< paths of the pilot, at most; fewer in small images
/// The estimated brightness of a tile is at least this fraction of the image's mean, so that chains also leave dark
/// tiles.
constexpr double kMinBrightness = 0.02;

// Holds the contribution of a path to pixels.
struct Contribution {
    std::vector<Splat> splats;
    /// This is the scalar contribution function I of Kelemen et al. 2002. Chains visit paths in proportion to it. It is
    /// the weighted sum of the luminance of the splats; see MetropolisPilot.
    double scalar = 0;
};

// The first block of random samples determines the position in the image, the point on the lens, and the time.
using FirstBlock = Sampler::Block;

// Traces pairs of subpaths, one pair after the other.
class PairTracer {
public:
    PairTracer(const PassContext& context, const LightEmission& emission, RayCounts& counts)
        : context_(context), camera_(context.view), counts_(counts),
          tracer_(context.plan, emission, context.view, context.settings.integrator, 0, counts) {}

    // Returns the camera ray of these random samples, and its hit.
    std::pair<Ray, Hit> camera_hit(const FirstBlock& u) {
        ++counts_.camera;
        const Ray ray = camera_.ray(pixel(u), lens(u), static_cast<double>(context_.plan.camera_needs.time ? u[4] : 0));
        return {ray, context_.plan.prepared.accelerator.closest(ray)};
    }

    // Computes the splats of the path with this camera ray. S is Sampler or PrimarySample.
    template <typename S>
    void trace(const FirstBlock& u, const std::pair<Ray, Hit>& seen, S& sample, std::vector<Splat>& splats) {
        const auto& [ray, hit] = seen;
        const Pinhole pinhole = camera_.pinhole(lens(u));
        splats.clear();
        tracer_.trace_light_subpath(ray.time, sample);
        tracer_.connect_to_camera(pinhole, splats);
        const Vec2d at = pixel(u);
        const auto index = static_cast<std::uint32_t>(at.y) * static_cast<std::uint32_t>(context_.view.width) +
                           static_cast<std::uint32_t>(at.x);
        splats.push_back({index, tracer_.trace_camera_subpath(ray, hit, pinhole, sample, nullptr)});
    }

private:
    Vec2d pixel(const FirstBlock& u) const {
        return {static_cast<double>(u[0]) * context_.view.width, static_cast<double>(u[1]) * context_.view.height};
    }
    Vec2d lens(const FirstBlock& u) const {
        return context_.plan.camera_needs.lens ? Vec2d(Vec2(u[2], u[3])) : Vec2d(0.5, 0.5);
    }

    const PassContext& context_;
    const CameraModel camera_;
    RayCounts& counts_;
    BidirectionalTracer tracer_;
};

// Estimates the radiance of all pixels. The independent paths estimate the mean b of the scalar contribution I. A chain
// starts at one of them, chosen in proportion to I. On average over these starts, it is in equilibrium from its first
// step on, so the contributions of its paths, times b / I, are an unbiased estimate (Veach 1997, §11.3.1).
class ChainedSample {
public:
    ChainedSample(const PassContext& context, const LightEmission& emission, const MetropolisPilot& pilot,
                  std::uint32_t index)
        : context_(context), emission_(emission), pilot_(pilot), index_(index),
          seed_(hash_combine(hash_combine(0, context.settings.seed), index)),
          sums_(context.view.width, context.view.height),
          chains_((sums_.size() * Metropolis::kStepsPerPixel + kStepsPerChain - 1) / kStepsPerChain),
          scalars_(sums_.size()) {}

    std::optional<Image<Rgbd>> render() {
        const auto height = static_cast<std::size_t>(context_.view.height);
        if (!add_splats(height, kRowsInGroup, [&](std::size_t y, PairTracer& tracer, std::vector<Splat>& sent) {
                trace_row(static_cast<int>(y), tracer, sent);
            }))
            return std::nullopt;
        std::partial_sum(scalars_.begin(), scalars_.end(), scalars_.begin());
        if (scalars_.back() > 0 &&
            !add_splats(chains_, kChainsInGroup, [&](std::size_t chain, PairTracer& tracer, std::vector<Splat>& sent) {
                run_chain(chain, tracer, sent);
            }))
            return std::nullopt;
        return std::move(sums_);
    }

private:
    // Calls body(i, …) for all i below `count`, and adds the splats. Returns false if it was stopped.
    template <typename Body> bool add_splats(std::size_t count, std::size_t group, const Body& body) {
        return run_in_order<std::vector<Splat>>(
            context_, count, group,
            [&](std::size_t i, std::vector<Splat>& splats, RayCounts& counts) {
                PairTracer tracer(context_, emission_, counts);
                body(i, tracer, splats);
            },
            [&](const std::vector<Splat>& splats) {
                for (const Splat& splat : splats) sums_[splat.pixel] += Rgbd(splat.light);
            });
    }

    // Returns the sampler of a pixel's independent path, and its first block of random samples.
    std::pair<Sampler, FirstBlock> independent_path(int x, int y) const {
        std::pair<Sampler, FirstBlock> path{context_.settings.make_sampler(), {}};
        auto& [sampler, u] = path;
        sampler.start(x, y, index_);
        u = sampler.get_block();
        const auto place = [](int i, float offset, int count) {
            return std::min((static_cast<float>(i) + offset) / static_cast<float>(count), kOneMinusEpsilon);
        };
        u[0] = place(x, u[0], sums_.width()), u[1] = place(y, u[1], sums_.height());
        return path;
    }

    void trace_row(int y, PairTracer& tracer, std::vector<Splat>& sent) {
        Contribution found;
        for (int x = 0; x < sums_.width(); ++x) {
            auto [sampler, u] = independent_path(x, y);
            const std::pair<Ray, Hit> seen = tracer.camera_hit(u);
            if (context_.aovs.any()) context_.aovs.add(x, y, index_, seen.first, seen.second);
            tracer.trace(u, seen, sampler, found.splats);
            set_scalar(found);
            const bool valid = std::isfinite(found.scalar);
            scalars_[static_cast<std::size_t>(y) * static_cast<std::size_t>(sums_.width()) +
                     static_cast<std::size_t>(x)] = valid ? found.scalar : 0;
            if (valid)
                send(found, 1 - weight_of_steps(found.scalar), sent);
            else
                send_invalid(found, sent);
        }
    }

    void set_scalar(Contribution& found) const {
        found.scalar = 0;
        for (const Splat& splat : found.splats)
            found.scalar += static_cast<double>(luminance(splat.light)) * pilot_.weight(splat.pixel);
    }

    // Returns the weight of chain steps in multiple importance sampling, by the balance heuristic: independent paths
    // have the density 1, and steps have kStepsPerPixel · I / b. Any constant in place of b gives an unbiased estimate,
    // but it must not depend on the paths at which the chains start.
    double weight_of_steps(double scalar) const {
        const double steps = Metropolis::kStepsPerPixel * scalar;
        return steps > 0 ? steps / (steps + pilot_.mean_contribution()) : 0;
    }

    void run_chain(std::size_t chain, PairTracer& tracer, std::vector<Splat>& sent) const {
        const std::uint64_t seed = hash_combine(seed_, chain);
        const auto uniform = [&](std::size_t i) {
            return static_cast<double>(unit_float(high_bits(stream_number(seed, i))));
        };
        const double u = (static_cast<double>(chain) + uniform(kStepsPerChain)) / static_cast<double>(chains_);
        PrimarySample sample = start_at(u * scalars_.back(), mix_bits(seed));
        Contribution current, proposal;
        trace(sample, tracer, current);
        double stay = 0; // expected number of steps at the current path
        for (std::size_t step = 0; step < kStepsPerChain; ++step) {
            sample.propose();
            trace(sample, tracer, proposal);
            // Both paths are weighted with the probabilities with which the chain continues from them (Veach 1997,
            // §11.3.2).
            const bool valid = std::isfinite(proposal.scalar);
            const double acceptance = valid ? std::min(1.0, proposal.scalar / current.scalar) : 0;
            stay += 1 - acceptance;
            if (uniform(step) < acceptance) {
                send_steps(current, stay, sent);
                std::swap(current, proposal);
                stay = acceptance;
                sample.accept();
            } else {
                if (valid)
                    send_steps(proposal, acceptance, sent);
                else
                    send_invalid(proposal, sent);
                sample.reject();
            }
        }
        send_steps(current, stay, sent);
    }

    // Returns the independent path at which the cumulative scalar contribution reaches `sum`.
    PrimarySample start_at(double sum, std::uint64_t seed) const {
        const auto found = std::upper_bound(scalars_.begin(), scalars_.end() - 1, sum);
        const auto i = static_cast<int>(found - scalars_.begin());
        const auto [sampler, u] = independent_path(i % sums_.width(), i / sums_.width());
        return {sampler, u, seed};
    }

    void trace(PrimarySample& sample, PairTracer& tracer, Contribution& found) const {
        sample.set_dimension(0);
        const FirstBlock u = sample.get_block();
        tracer.trace(u, tracer.camera_hit(u), sample, found.splats);
        set_scalar(found);
    }

    void send_steps(const Contribution& contribution, double steps, std::vector<Splat>& sent) const {
        if (steps == 0) return;
        const double b = scalars_.back() / static_cast<double>(sums_.size()), scalar = contribution.scalar;
        const double pixels_per_step =
            static_cast<double>(sums_.size()) / static_cast<double>(chains_ * kStepsPerChain);
        send(contribution, weight_of_steps(scalar) * steps * pixels_per_step * b / scalar, sent);
    }
    static void send(const Contribution& found, double factor, std::vector<Splat>& sent) {
        for (const Splat& splat : found.splats)
            if (!is_black(splat.light)) sent.push_back({splat.pixel, Rgb(Rgbd(splat.light) * factor)});
    }

    // Sends the invalid splats, which the film then reports.
    static void send_invalid(const Contribution& found, std::vector<Splat>& sent) {
        for (const Splat& splat : found.splats)
            if (!is_finite(splat.light)) sent.push_back(splat);
    }

    const PassContext& context_;
    const LightEmission& emission_;
    const MetropolisPilot& pilot_;
    const std::uint32_t index_;
    const std::uint64_t seed_;
    Image<Rgbd> sums_;
    const std::size_t chains_;
    // The vector holds the scalar contributions of the independent paths; once all are traced, their cumulative sums.
    std::vector<double> scalars_;
};

} // namespace

MetropolisPilot::MetropolisPilot(const PassContext& context, const LightEmission& emission)
    : width_(context.view.width), height_(context.view.height) {
    const double pixels = static_cast<double>(width_) * static_cast<double>(height_);
    const auto paths = static_cast<int>(std::min(pixels, double{kPilotPaths}));
    tiles_ = std::clamp(static_cast<int>(std::sqrt(paths / kPathsPerTile)), 1, kMaxTiles);
    weights_.assign(static_cast<std::size_t>(tiles_ * tiles_), 1);
    const std::vector<double> light = light_of_tiles(context, emission, paths);
    const double mean = std::accumulate(light.begin(), light.end(), 0.0);
    for (std::size_t i = 0; i < light.size() && mean > 0; ++i) {
        if (light[i] == 0) {
            weights_[i] = 1 / (kMinBrightness * mean);
            continue;
        }
        const double fraction = pixels_of_tile(i) / pixels;
        weights_[i] = 1 / std::max(light[i] / fraction, kMinBrightness * mean);
        mean_ += light[i] * weights_[i];
    }
}

// Returns the luminance that reaches each tile, as a fraction of that of an image of luminance 1.
std::vector<double> MetropolisPilot::light_of_tiles(const PassContext& context, const LightEmission& emission,
                                                    int paths) const {
    constexpr int kChunk = 256; // paths per task
    using Light = std::vector<double>;
    Light light(weights_.size());
    run_in_order<Light>(
        context, static_cast<std::size_t>((paths + kChunk - 1) / kChunk), kPilotPaths,
        [&](std::size_t chunk, Light& found, RayCounts& counts) {
            found.assign(weights_.size(), 0);
            PairTracer tracer(context, emission, counts);
            Sampler sampler(SamplerKind::kIndependent, context.settings.seed, 1);
            std::vector<Splat> splats;
            const int first = static_cast<int>(chunk) * kChunk;
            for (int i = first; i < std::min(first + kChunk, paths); ++i) {
                sampler.start(-1, i, 0);
                const FirstBlock u = sampler.get_block();
                tracer.trace(u, tracer.camera_hit(u), sampler, splats);
                for (const Splat& splat : splats)
                    if (is_finite(splat.light))
                        found[tile(splat.pixel)] += static_cast<double>(luminance(splat.light)) / paths;
            }
        },
        [&](const Light& found) {
            for (std::size_t i = 0; i < light.size(); ++i) light[i] += found[i];
        });
    return light;
}

// Returns the number of pixels in a tile. Row or column i belongs to the tile number ⌊i · tiles / count⌋.
double MetropolisPilot::pixels_of_tile(std::size_t tile) const {
    const auto length = [&](std::int64_t k, int count) {
        const auto first = [&](std::int64_t n) { return (n * count + tiles_ - 1) / tiles_; };
        return static_cast<double>(first(k + 1) - first(k));
    };
    const auto index = static_cast<std::int64_t>(tile);
    return length(index % tiles_, width_) * length(index / tiles_, height_);
}

std::size_t MetropolisPilot::tile(std::uint32_t pixel) const {
    const int x = static_cast<int>(pixel) % width_, y = static_cast<int>(pixel) / width_;
    const auto place = [&](int i, int count) { return std::int64_t{i} * tiles_ / count; };
    return static_cast<std::size_t>(place(y, height_) * tiles_ + place(x, width_));
}

std::optional<Image<Rgbd>> Metropolis::sample(std::uint32_t index) const {
    return ChainedSample(context_, emission_, pilot_, index).render();
}

} // namespace duet::raytrace

// This file measures whether a render stops where it should: it compares the achieved error with the requested error,
// and the time taken with the time limit. It also compares adaptive sampling with uniform sampling at the same sample
// count.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"
#include "common/system/control.h"
#include "compare/bench/reference.h"

#include <optional>
#include <vector>

namespace duet::compare {

/// Says what is rendered, and how often.
struct StopSettings {
    double error = 1e-3; ///< requested relMSE
    double time = 0;     ///< time limit in seconds for a second experiment; 0: none
    int seeds = 20;
    int threads = 0;     ///< 0: all hardware threads
};

/// Holds the trial of one seed: a render with an error limit, and a uniformly sampled one with the same mean sample
/// count.
struct StopTrial {
    std::uint64_t seed = 0;
    double samples = 0;           ///< mean samples per pixel at the end
    double seconds = 0, uniform_seconds = 0;
    double estimated_relmse = 0;  ///< relMSE as estimated by the render
    double relmse = 0, mse = 0;   ///< against the reference, minus the reference's own error
    double uniform_relmse = 0, uniform_mse = 0;
};
/// Holds the trial of one render with a time limit.
struct TimeTrial {
    double seconds = 0;  ///< time of the render
    double one_pass = 0; ///< time of the smallest final pass: two samples per pixel
};

/// Holds the trials and results of a scene. Ratios of squared errors are ratios of their means over the seeds.
struct StopResult {
    std::vector<StopTrial> trials;
    std::vector<TimeTrial> times;
    bool caustics = false; ///< result of has_caustics

    double median_error() const;  ///< achieved relMSE, median over the seeds
    double mean_samples() const;
    bool stopped_at_minimum() const;  ///< whether at least half of the seeds stopped at the minimum sample count
    double cost_ratio_relmse() const; ///< adaptive over uniform sampling in relMSE × seconds; below 1, adaptivity pays
    double cost_ratio_mse() const;
};

/// Returns whether the scene may have caustics that camera paths seldom find: it has a specular surface (mirror
/// or glass) and a light that is sampled. No error estimate accounts for light that no sample has found.
bool has_caustics(const Scene& scene);

/// Returns nothing if stopped.
std::optional<StopResult> measure_stop(const Scene& scene, const View& view, const Reference& reference,
                                       const StopSettings& settings, Control& control);

} // namespace duet::compare

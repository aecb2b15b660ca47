// Whether a render ends where it was told to: the error it got against the error asked for, the time it took against the
// time allowed; and what adaptive sampling is worth beside as many samples spread evenly.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"
#include "common/system/control.h"
#include "compare/bench/reference.h"

#include <optional>
#include <vector>

namespace duet::compare {

struct StopSettings {
    double error = 1e-3; ///< relMSE asked for
    double time = 0;     ///< seconds asked for in a second experiment; 0: none
    int seeds = 20;
    int threads = 0;     ///< 0: all
};

/// One seed: a render to an error, and one with as many samples in the mean, spread evenly.
struct StopTrial {
    std::uint64_t seed = 0;
    double samples = 0;           ///< a pixel, in the mean, when it ended
    double seconds = 0, even_seconds = 0;
    double stated = 0;            ///< relMSE, as the render estimated it
    double relmse = 0, mse = 0;   ///< against the reference, less the reference's own error
    double even_relmse = 0, even_mse = 0;
};
/// One render to a time.
struct TimeTrial {
    double seconds = 0;  ///< of the render
    double one_pass = 0; ///< of the least pass that there is at the end: two samples a pixel
};

/// A scene's trials and what they say. Ratios of squared errors are ratios of their means over the seeds.
struct StopResult {
    std::vector<StopTrial> trials;
    std::vector<TimeTrial> times;
    bool caustics = false; ///< see has_caustics

    double median_error() const;  ///< relMSE got, the median of the seeds
    double mean_samples() const;
    bool at_once() const; ///< half of the seeds, or more, ended with the least samples that there may be
    double to_even_relmse() const; ///< adaptive over even: of relMSE × seconds, below 1 where adaptivity pays
    double to_even_mse() const;
};

/// Whether light may be focused by mirrors or glass into spots that camera paths seldom find: there is a mirror, or
/// glass, and a light that is sampled. No error estimate knows of light that no sample has found.
bool has_caustics(const Scene& scene);

/// Empty where it was stopped.
std::optional<StopResult> measure_stop(const Scene& scene, const View& view, const Reference& reference,
                                       const StopSettings& settings, Control& control);

} // namespace duet::compare

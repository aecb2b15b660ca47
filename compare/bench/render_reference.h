// The references of one scene: the path tracer's, and one by an independent estimator, found in the cache or rendered.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/scene.h"
#include "common/system/control.h"
#include "compare/bench/bias_check.h"
#include "compare/bench/reference.h"

#include <functional>
#include <optional>
#include <string>

namespace duet::compare {

struct ReferenceSettings {
    std::filesystem::path folder; ///< of the cache
    int spp = 1024;
    int depth = 64;
    int threads = 0;
};

/// A reference and where it is from.
struct KeptReference {
    Reference reference;
    std::string estimator;
    std::filesystem::path file;
    bool rendered = false; ///< now; else it was in the cache

    explicit operator bool() const { return !reference.mean.empty(); }
};

/// By the path tracer's integrator of that name ("path", "naive"), Sobol samples, and a seed of its own. Rendered and
/// stored where the cache has none. Empty where it was stopped: then the film is kept beside where the reference will be,
/// and the next time goes on from there.
KeptReference reference_by(const std::string& estimator, const Scene& scene, const View& view,
                           const ReferenceSettings& settings, Control& control);

/// By something else: rendered with kReferenceSeeds seeds of equal shares of the samples, whose spread tells the
/// variance (each pixel's with kReferenceSeeds − 1 degrees of freedom).
inline constexpr int kReferenceSeeds = 8;
struct EstimatorId {
    std::string name;    ///< these three as in ReferenceKey
    int version = 0;
    std::string program;
};
KeptReference reference_by_seeds(const EstimatorId& estimator, const Scene& scene, const View& view,
                                 const ReferenceSettings& settings,
                                 const std::function<ImageRgb(int spp, std::uint64_t seed)>& render, Control& control);

/// Why `naive` cannot check a scene, or nothing where it can.
std::string unfit_for_naive(const Scene& scene);

} // namespace duet::compare

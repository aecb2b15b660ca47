// This file declares the reference images of one scene, by the path tracer and by independent estimators, from the
// cache or newly rendered.
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

/// Holds the settings of a reference.
struct ReferenceSettings {
    std::filesystem::path folder; ///< cache folder
    int spp = 1024;
    int depth = 64;
    int threads = 0;
};

/// A CachedReference is a reference and its origin.
struct CachedReference {
    Reference reference;
    std::string estimator;
    std::filesystem::path file;
    bool rendered = false; ///< rendered now; else it was in the cache

    explicit operator bool() const { return !reference.mean.empty(); }
};

/// Returns a reference by the path tracer's integrator of that name ("path", "naive"), with Sobol samples and a
/// separate seed. If it is not in the cache, it is rendered and stored there. If stopped, returns an empty
/// reference; the film is stored next to the reference's file, and the next call resumes from it.
CachedReference reference_by(const std::string& estimator, const Scene& scene, const View& view,
                             const ReferenceSettings& settings, Control& control);

/// This is the number of seeds for a reference by another renderer. Each seed gets an equal fraction of the samples.
/// The spread of the images yields the variance, with kReferenceSeeds − 1 degrees of freedom per pixel.
inline constexpr int kReferenceSeeds = 8;
/// Identifies the estimator that renders a reference.
struct EstimatorId {
    std::string name;    ///< name, version and program are as in ReferenceKey
    int version = 0;
    std::string program;
};
/// Returns a reference by another renderer. If it is not in the cache, `render` is called kReferenceSeeds times, and
/// the result is stored there.
CachedReference reference_by_seeds(const EstimatorId& estimator, const Scene& scene, const View& view,
                                   const ReferenceSettings& settings,
                                   const std::function<ImageRgb(int spp, std::uint64_t seed)>& render,
                                   Control& control);

/// Returns the reason why the estimator `naive` cannot check a scene, or an empty text if it can.
std::string naive_limitation(const Scene& scene);

} // namespace duet::compare

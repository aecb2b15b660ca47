// This file declares the bench's renderers: each has its own settings and is measured at several sample counts.
#pragma once

#include "common/camera/camera.h"
#include "common/image/image.h"
#include "common/scene/scene.h"
#include "common/system/control.h"
#include "raytrace/sampling/sampler.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace duet::compare {

/// A TimedImage is a rendered image and its cost.
struct TimedImage {
    ImageRgb image;
    double seconds = 0;     ///< wall-clock time of the render alone, without loading, building or writing
    double cpu_seconds = 0; ///< sum over all threads; less than threads × seconds if other processes used the CPU; 0:
                            ///< unknown (for a peer)
};

/// A BenchRenderer is a renderer with settings, prepared for one scene and view.
struct BenchRenderer {
    std::string technique; ///< "raster", an integrator, "adaptive", "denoised" or "no-roulette" (path), or a
                           ///< peer's name
    std::string sampler;   ///< empty if the technique has no choice of samplers
    std::string note;      ///< sentences on what the technique omits; empty if it converges to the reference
    std::vector<int> spps;
    std::function<TimedImage(int spp, std::uint64_t seed, Control& control)> render;
};

/// Selects which of Duet's own techniques are measured.
struct RendererChoice {
    std::vector<std::string> techniques = {"raster", "path", "naive"};
    std::vector<std::string> samplers = {"sobol", "stratified", "independent"}; ///< samplers for the path tracer's
                                                                                ///< techniques
    std::vector<int> spps = {1, 4, 16, 64};
    int depth = 64;  ///< maximum number of scattering events of the path tracer
    int threads = 0; ///< 0: all hardware threads
};

/// Throws Error for an unknown technique or sampler.
void check_renderer_choice(const RendererChoice& choice);

/// Throws Error unless an integrator may render references.
void check_reference_integrator(const std::string& name);

/// Throws Error if a technique, or the integrator of the references, does not support the scene.
void check_supported(const Scene& scene, std::vector<std::string> techniques, const std::string& reference_by);

/// Prepares both pipelines as needed and returns a renderer for each technique × sampler; "raster" is a single
/// renderer. The scene must outlive them.
std::vector<BenchRenderer> duet_renderers(const Scene& scene, const View& view, const RendererChoice& choice);

/// This is the least duration of a timing in seconds, because clocks and schedulers disturb shorter ones.
inline constexpr double kMinTimingSeconds = 0.05;
/// Calls `render` repeatedly, with the same result, until kMinTimingSeconds seconds have passed or `control` is
/// stopped. Returns the image and the average times per call.
TimedImage time_render(const std::function<ImageRgb()>& render, const Control& control);

} // namespace duet::compare

// What the bench measures: ways to render a scene, each at several numbers of samples.
#pragma once

#include "common/camera/camera.h"
#include "common/image/image.h"
#include "common/sampling/sampler.h"
#include "common/scene/scene.h"
#include "common/system/control.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace duet::compare {

/// One picture and what it cost.
struct Trial {
    ImageRgb picture;
    double seconds = 0;     ///< of the render alone, wall clock: nothing loaded, built, or written
    double cpu_seconds = 0; ///< of all threads together; less than threads × seconds where others used the machine; 0:
                            ///< not known (a peer's)
};

/// A way to render, prepared for one scene and view.
struct Contender {
    std::string technique; ///< "raster", a path tracer's integrator, "adaptive" or "no-roulette" (path), or a peer's name
    std::string sampler;   ///< empty where the technique has no choice of them
    std::string note;      ///< what it leaves out, in sentences; empty: it converges to the reference
    std::vector<int> spps;
    std::function<Trial(int spp, std::uint64_t seed, Control& control)> render;

    std::string name() const { return sampler.empty() ? technique : technique + ", " + sampler; }
};

/// What is to be measured of our own renderers.
struct ContenderChoice {
    std::vector<std::string> techniques = {"raster", "path", "naive"};
    std::vector<std::string> samplers = {"sobol", "stratified", "independent"}; ///< of the path tracer's techniques
    std::vector<int> spps = {1, 4, 16, 64};
    int depth = 64;  ///< the path tracer's scattering events at most
    int threads = 0; ///< 0: all
};

/// Throws Error for a technique or sampler that there is not.
void check_choice(const ContenderChoice& choice);

/// Prepares both pipelines as needed. Each technique × sampler is a contender; "raster" is one by itself. The scene
/// must outlive them.
std::vector<Contender> our_contenders(const Scene& scene, const View& view, const ContenderChoice& choice);

/// Runs `render` and fills in both times: it is called again, with the same result, until kShortestTiming seconds have
/// passed (of which each gets its share), since clocks and schedulers disturb shorter ones.
inline constexpr double kShortestTiming = 0.05;
Trial timed(const std::function<ImageRgb()>& render, const Control& control);

} // namespace duet::compare

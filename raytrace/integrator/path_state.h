// What a path keeps from vertex to vertex.
#pragma once

#include "common/light/light_bounds.h"

namespace duet::raytrace {

/// How the ray left the vertex before: what its chance to find a light is weighed against.
struct Departure {
    LightReceiver receiver;
    float pdf = 0;
    bool certain = true; ///< no light sample competes: a camera ray, or a delta lobe
};

struct PathState {
    Rgb throughput{1.0f};
    float refraction = 1; ///< what the path's refractions have scaled its throughput by
    Departure departure;
};

/// Russian roulette ends dim paths, and lets the survivors stand for them: this is the probability to go on, where it is
/// below 1. `worth` is RenderPlan's; the throughput is taken without what refraction did to it. T is float or a batch of
/// floats.
template <typename T> T survival(RgbT<T> throughput, T refraction, T worth) {
    return max_component(throughput) * worth / refraction;
}

} // namespace duet::raytrace

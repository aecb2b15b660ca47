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

/// Russian roulette ends dim paths, and lets the survivors stand for them. Whatever it ends it also makes noisier, and
/// well placed samples suffer most: a path of half its throughput is still worth its rays (README.md has what other
/// thresholds cost). This is the probability to go on, where it is below 1: by the throughput without what refraction did
/// to it. T is float or a batch of floats.
template <typename T> T survival(RgbT<T> throughput, T refraction) {
    constexpr float kDim = 0.25f;
    return max_component(throughput) / (refraction * T(kDim));
}

} // namespace duet::raytrace

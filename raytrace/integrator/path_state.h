// Declares PathState, the state that a path carries from vertex to vertex.
#pragma once

#include "common/light/light_bounds.h"

namespace duet::raytrace {

/// Holds how the ray left the previous vertex. MIS needs it to weight light that the ray finds against light samples
/// at that vertex.
struct PreviousVertex {
    LightReceiver receiver;
    float pdf = 0;
    bool no_light_sample = true; ///< whether no light sample competes, as after a camera ray or a delta lobe
};

/// Holds the factors that scattering changes. T is float, or a batch of floats for one path per lane.
template <typename T> struct PathThroughputT {
    RgbT<T> throughput{T(1.0f)};
    T refraction = T(1.0f); ///< factor by which refractions have scaled the throughput
};
/// Holds the state of a single path.
struct PathState : PathThroughputT<float> {
    PreviousVertex previous_vertex;
};

} // namespace duet::raytrace

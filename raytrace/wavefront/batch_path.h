// Defines one path of a batch.
#pragma once

#include "common/vec/simd.h"
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_state.h"

namespace duet::raytrace {

/// This is the number of paths in a batch, which is the number of lanes of doubles.
inline constexpr std::size_t kPathLanes = kDoubleLanes;

/// Describes one path of a batch. It refers to data of the caller.
struct BatchPath {
    std::uint32_t index; ///< index that identifies the path among its shadow rays
    Ray* ray;       ///< the ray that hit; replaced by the next ray if the path continues
    const Hit* hit; ///< hit of `ray`
    const Shape* shape; ///< shape at the hit
    const Bsdf* bsdf;   ///< BSDF at the hit
    const VertexRandomSamples* random_samples;
    PathState* state;
    bool continues = false;
};

} // namespace duet::raytrace

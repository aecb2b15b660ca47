// This header declares the result of ambient occlusion.
#pragma once

#include "common/vec/vec.h"

namespace duet::raster {

/// Stores the unoccluded part of the hemisphere over a point, cosine-weighted.
template <typename T> struct SkyVisibility {
    T visible = T(1); ///< unoccluded fraction, in [0, 1]
    Vec3T<T> hidden{T(0), T(0),
                    T(0)}; ///< ∫ w cos dw / π over the occluded directions; 2/3 of the normal if all are occluded
};

} // namespace duet::raster

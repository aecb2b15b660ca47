// What occlusion leaves of the light from all around.
#pragma once

#include "common/vec/vec.h"

namespace duet::raster {

/// What a point sees of the directions over it, each weighed by its cosine to the normal.
template <typename T> struct SkySeenT {
    T visible = T(1); ///< the part that nothing hides, in [0, 1]
    Vec3T<T> hidden;  ///< ∫ w cos dw / π over the others: of all of them, 2/3 of the normal
};
using SkySeen = SkySeenT<float>;

} // namespace duet::raster

// Converts vectors between SIMD batches of floats and of doubles with the same number of lanes.
#pragma once

#include "common/vec/simd.h"
#include "common/vec/vec.h"

namespace duet {

/// Rounds each component to float.
inline Vec3T<NarrowBatch> to_floats(const Vec3T<DoubleBatch>& v) {
    return {to_floats(v.x), to_floats(v.y), to_floats(v.z)};
}
/// Widens each component to double, which is exact.
inline Vec3T<DoubleBatch> to_doubles(const Vec3T<NarrowBatch>& v) {
    return {to_doubles(v.x), to_doubles(v.y), to_doubles(v.z)};
}

} // namespace duet

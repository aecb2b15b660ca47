// This file defines orthonormal frames around a unit normal. BSDFs are evaluated in such a local frame, with n = +z.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// A frame is a right-handed orthonormal basis. It converts vectors between its local space and the world.
template <typename T> struct FrameT {
    Vec3T<T> s{T(1), T(0), T(0)}, t{T(0), T(1), T(0)}, n{T(0), T(0), T(1)};

    constexpr Vec3T<T> to_local(Vec3T<T> v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
    constexpr Vec3T<T> to_world(Vec3T<T> v) const { return s * v.x + t * v.y + n * v.z; }
};
using Frame = FrameT<float>;

/// Returns a right-handed orthonormal frame around the unit vector n. The method has no branch and no singularity, not
/// even at n = −z (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3).
template <typename T> FrameT<T> frame_from_normal(Vec3T<T> n) {
    const T sign = select(n.z < T(0), T(-1), T(1));
    const T a = T(-1) / (sign + n.z);
    const T b = n.x * n.y * a;
    return {{T(1) + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

} // namespace duet

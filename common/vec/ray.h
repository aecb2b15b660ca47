// This file defines rays.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// A ray is the set of points origin + t·direction with t in (t_min, t_max]. A camera ray's direction has unit length.
/// A ray that is transformed to object space keeps its t, so its direction there may have any length.
template <Arithmetic T> struct RayT {
    Vec3T<T> origin;
    Vec3T<T> direction;
    T t_min = T(0);
    T t_max = std::numeric_limits<T>::infinity();
    T time = T(0); ///< time as a fraction of the objects' motion, in [0, 1]

    constexpr Vec3T<T> at(T t) const { return origin + direction * t; }
};
using Ray = RayT<float>;
using Rayd = RayT<double>;

} // namespace duet

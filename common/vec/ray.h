// Rays.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// Points origin + t·direction with t in (t_min, t_max]. A camera ray's direction has unit length; a ray taken into
/// an object's space keeps its t and so need not.
template <Arithmetic T> struct RayT {
    Vec3T<T> origin;
    Vec3T<T> direction;
    T t_min = T(0);
    T t_max = std::numeric_limits<T>::infinity();
    T time = T(0); ///< within the shutter interval: 0 = opens, 1 = closes

    constexpr Vec3T<T> at(T t) const { return origin + direction * t; }
};
using Ray = RayT<float>;
using Rayd = RayT<double>;

} // namespace duet

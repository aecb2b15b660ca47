// This file defines intervals of a ray.
#pragma once

#include "common/vec/scalar.h"

namespace duet {

/// An Interval holds all t with begin < t < end. It is empty where begin >= end.
template <typename T> struct IntervalT {
    T begin = T(0), end = T(0);
    MaskOf<T> empty() const { return !(begin < end); }
};
using Interval = IntervalT<float>;

} // namespace duet

// This file defines axis-aligned bounding boxes.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// An axis-aligned box holds all points p with low <= p <= high on each axis. A default-constructed box is empty: its
/// low corner is +infinity and its high corner is −infinity.
template <Arithmetic T> struct Box3T {
    Vec3T<T> low{std::numeric_limits<T>::infinity(), std::numeric_limits<T>::infinity(),
                 std::numeric_limits<T>::infinity()};
    Vec3T<T> high{-low.x, -low.y, -low.z};

    constexpr bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
    constexpr Vec3T<T> diagonal() const { return high - low; }
    constexpr Vec3T<T> center() const { return low * T(0.5) + high * T(0.5); }
    /// Returns corner i of 0 to 7. Bits 0, 1 and 2 of i select the high end of the x, y and z axis.
    constexpr Vec3T<T> corner(unsigned i) const {
        return {(i & 1u ? high : low).x, (i & 2u ? high : low).y, (i & 4u ? high : low).z};
    }
    /// Returns half the surface area, which is 0 for an empty box.
    constexpr T half_area() const {
        const Vec3T<T> d = diagonal();
        return empty() ? T(0) : d.x * d.y + d.y * d.z + d.z * d.x;
    }
    constexpr void extend(Vec3T<T> p) {
        low = min(low, p);
        high = max(high, p);
    }
    constexpr void extend(const Box3T& b) {
        low = min(low, b.low);
        high = max(high, b.high);
    }
    constexpr bool contains(Vec3T<T> p) const {
        return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y && low.z <= p.z && p.z <= high.z;
    }
};
using Box3 = Box3T<float>;
using Box3d = Box3T<double>;

/// Returns the index (0, 1 or 2) of the largest component of d. Of equal components, the lowest index wins.
template <Arithmetic T> constexpr std::size_t longest_axis(Vec3T<T> d) {
    return d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
}

} // namespace duet

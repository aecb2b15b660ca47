// Where in an image a place in its period falls; for one place or a batch.
#pragma once

#include "common/image/rgb.h"
#include "common/vec/simd.h"

#include <cmath>

namespace duet {

/// The place of a coordinate within its period, in [0, 1); 0 for what has none (infinity, NaN). The difference is exact
/// but for negative coordinates so small that it would round to 1.
template <typename T> T fraction(T t) {
    using std::floor;
    const T place = t - floor(t);
    return select(place >= T(0), min(place, T(kOneMinusEpsilon)), T(0));
}

/// The two texels of `count` along a side whose centres enclose a place in [0, 1), as whole numbers, and the second one's
/// weight: 0 exactly at the first one's centre.
template <typename T> struct TexelPair {
    T first, second, weight;

    TexelPair(T place, T count) {
        using std::floor;
        const T x = place * count - T(0.5), below = floor(x); // in [−1, count − 1]
        first = select(below < T(0), count - T(1), below);
        second = select(below + T(1) < count, below + T(1), T(0));
        weight = x - below;
    }
};

/// From a to b as t goes from 0 to 1: a itself at 0, and between two that are equal.
template <typename T> T between(const T& a, const T& b, const T& t) { return fused(t, b - a, a); }
template <typename T> RgbT<T> between(const RgbT<T>& a, const RgbT<T>& b, const T& t) {
    return {between(a.r, b.r, t), between(a.g, b.g, t), between(a.b, b.b, t)};
}

/// Texels at (first, first), (second, first), (first, second) and (second, second) along x and y, by the second ones' weights.
template <typename Color, typename T>
Color bilinear(const Color& t00, const Color& t10, const Color& t01, const Color& t11, const T& x, const T& y) {
    return between(between(t00, t10, x), between(t01, t11, x), y);
}

} // namespace duet

// Where in an image a place in its period falls; for one place or a batch.
#pragma once

#include "common/image/rgb.h"
#include "common/vec/simd.h"

#include <cmath>

namespace duet {

/// The place of a coordinate within its period, in [0, 1); 0 for what has none (infinity, NaN). The difference is exact
/// but for the tiniest negative coordinates, which would round to 1.
template <typename T> T fraction(T t) {
    using std::floor;
    const T place = t - floor(t);
    return select(place < T(1), place, T(0));
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

/// Texels at (first, first), (second, first), (first, second) and (second, second) along x and y, by the second ones' weights.
template <typename T> RgbT<T> bilinear(const RgbT<T>& t00, const RgbT<T>& t10, const RgbT<T>& t01, const RgbT<T>& t11, T x, T y) {
    return lerp(lerp(t00, t10, x), lerp(t01, t11, x), y);
}

} // namespace duet

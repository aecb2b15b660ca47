// This file maps texture coordinates to texels and weights, for one coordinate or a batch of them.
#pragma once

#include "common/image/rgb.h"
#include "common/vec/simd.h"

#include <cmath>

namespace duet {

/// Returns the fractional part of a coordinate, in [0, 1), which wraps it into one period. The result is 0 for
/// infinity and NaN. The subtraction is exact, except for negative coordinates so small that the result would round
/// to 1.
template <typename T> T wrap_repeat(T t) {
    using std::floor;
    const T s = t - floor(t);
    return select(s >= T(0), min(s, T(kOneMinusEpsilon)), T(0));
}

/// A TexelPair holds the two texels along an axis of `count` texels whose centers enclose a coordinate in [0, 1).
/// Indices are stored as floating-point integers. `weight` is that of the second texel, and exactly 0 at the center
/// of the first.
template <typename T> struct TexelPair {
    T first, second, weight;

    TexelPair(T s, T count) {
        using std::floor;
        const T x = s * count - T(0.5), below = floor(x); // `below` is in [−1, count − 1]
        first = select(below < T(0), count - T(1), below);
        second = select(below + T(1) < count, below + T(1), T(0));
        weight = x - below;
    }
};

/// Interpolates linearly from a to b as t goes from 0 to 1. The result is exactly a at t = 0, and exact where a
/// equals b.
template <typename T> T lerp_fused(const T& a, const T& b, const T& t) { return multiply_add(t, b - a, a); }
template <typename T> RgbT<T> lerp_fused(const RgbT<T>& a, const RgbT<T>& b, const T& t) {
    return {lerp_fused(a.r, b.r, t), lerp_fused(a.g, b.g, t), lerp_fused(a.b, b.b, t)};
}

/// Interpolates bilinearly. txy is the texel at (first or second, first or second) along x and y, and x and y are the
/// weights of the second texels.
template <typename Color, typename T>
Color bilinear(const Color& t00, const Color& t10, const Color& t01, const Color& t11, const T& x, const T& y) {
    return lerp_fused(lerp_fused(t00, t10, x), lerp_fused(t01, t11, x), y);
}

} // namespace duet

// These functions support robust floating-point arithmetic: products without cancellation, rounding-error bounds, and
// adjacent floats.
#pragma once

#include "common/vec/vec.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace duet {

/// Returns a·b − c·d with an error below 1.5 ulp of the result, however close the products are (Kahan's algorithm;
/// proof: Jeannerod, Louvet and Muller 2013). Exchanging the two products does not always give exactly the negated
/// result.
template <Arithmetic T> T difference_of_products(T a, T b, T c, T d) {
    const T cd = c * d;
    const T difference = std::fma(a, b, -cd);
    const T error = std::fma(-c, d, cd);
    return difference + error;
}

/// The unit roundoff u is half the distance from 1 to the next larger number of type T. It bounds the relative error of
/// one rounded operation.
template <typename T> inline constexpr T kRoundoff = std::numeric_limits<T>::epsilon() / 2;

/// Returns γₙ = n·u / (1 − n·u), where u is the unit roundoff. γₙ bounds the relative error of n rounded
/// operations in sequence (Higham 2002, §3.1).
template <typename T = float> constexpr T gamma_bound(int n) {
    return (static_cast<T>(n) * kRoundoff<T>) / (T(1) - static_cast<T>(n) * kRoundoff<T>);
}

/// Returns the next float above x. Infinity and NaN are returned unchanged. The result is that of std::nextafter, but
/// the function can be inlined.
inline float next_up(float x) {
    if (!(x < std::numeric_limits<float>::infinity())) return x;
    const auto bits = std::bit_cast<std::uint32_t>(x == 0 ? 0.0f : x); // −0 becomes +0
    return std::bit_cast<float>(x >= 0 ? bits + 1 : bits - 1);
}
/// Returns the next float below x. −infinity and NaN are returned unchanged.
inline float next_down(float x) { return -next_up(-x); }

/// Moves each component of `sum` by one float in the direction of the same component of `by`; where that is 0, the
/// component stays. The step makes up for the rounding of the addition p + by that produced `sum`.
inline Vec3 rounded_away(Vec3 sum, Vec3 by) {
    const auto one = [](float x, float d) { return d > 0 ? next_up(x) : d < 0 ? next_down(x) : x; };
    return {one(sum.x, by.x), one(sum.y, by.y), one(sum.z, by.z)};
}

} // namespace duet

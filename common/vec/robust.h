// Robust floating-point arithmetic: products without cancellation, error bounds, neighbours.
#pragma once

#include "common/system/sabotage.h"
#include "common/vec/vec.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace duet {

/// a·b − c·d with an error below 1.5 ulp of the result, however close the products are (Kahan's algorithm; proof:
/// Jeannerod, Louvet and Muller 2013). Not antisymmetric in the exchange of the two products.
inline float difference_of_products(float a, float b, float c, float d) {
    if (sabotaged(Guard::kDifferenceOfProducts)) return a * b - c * d;
    const float cd = c * d;
    const float difference = std::fma(a, b, -cd);
    const float error = std::fma(-c, d, cd);
    return difference + error;
}
inline double difference_of_products(double a, double b, double c, double d) {
    const double cd = c * d;
    const double difference = std::fma(a, b, -cd);
    const double error = std::fma(-c, d, cd);
    return difference + error;
}

/// Half the distance from 1 to the next float: the bound on the relative error of one rounded operation.
template <typename T> inline constexpr T kRoundoff = std::numeric_limits<T>::epsilon() / 2;

/// γₙ = n·u / (1 − n·u): bounds the relative error of n rounded operations in sequence (Higham 2002, §3.1).
template <typename T = float> constexpr T gamma_bound(int n) {
    return (static_cast<T>(n) * kRoundoff<T>) / (T(1) - static_cast<T>(n) * kRoundoff<T>);
}

/// The next float above x; infinity stays. NaN stays NaN. (std::nextafter's result, without its call.)
inline float next_up(float x) {
    if (!(x < std::numeric_limits<float>::infinity())) return x;
    const auto bits = std::bit_cast<std::uint32_t>(x == 0 ? 0.0f : x); // of −0, too, the least positive number is next
    return std::bit_cast<float>(x >= 0 ? bits + 1 : bits - 1);
}
/// The next float below x; −infinity stays. NaN stays NaN.
inline float next_down(float x) { return -next_up(-x); }

/// The next float of each component on the side that `by` points to: what covers the rounding of a sum with `by`.
inline Vec3 rounded_away(Vec3 sum, Vec3 by) {
    const auto one = [](float x, float d) { return d > 0 ? next_up(x) : d < 0 ? next_down(x) : x; };
    return {one(sum.x, by.x), one(sum.y, by.y), one(sum.z, by.z)};
}

} // namespace duet

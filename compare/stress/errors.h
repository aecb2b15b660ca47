// This header declares errors in the units of the stated bounds. The error of a NaN result is NaN, which fails any
// bound.
#pragma once

#include "common/vec/robust.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

/// Returns the larger of two errors; NaN counts as larger than all.
inline double larger_error(double a, double b) { return std::isnan(a) || a > b ? a : b; }

/// Returns |value − exact| in ulp of T at `exact`: the spacing of T in that binade.
template <typename T> double ulps(T value, long double exact) {
    int exponent = 0;
    std::frexp(exact, &exponent); // |exact| is in [2^(exponent − 1), 2^exponent)
    const int lowest = std::numeric_limits<T>::min_exponent; // below it the spacing is constant
    const long double ulp = std::ldexp(1.0L, std::max(exponent, lowest) - std::numeric_limits<T>::digits);
    return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / ulp);
}

/// Returns |value − exact| / |exact|, or 0 if both are equal, including 0.
inline double relative_error(double value, double exact) {
    return value == exact ? 0 : std::abs(value - exact) / std::abs(exact);
}

/// Returns an absolute error in units of u = 2^-24, the bound of one rounding of a float near 1.
inline double in_roundoffs(double error) { return std::abs(error) / static_cast<double>(kRoundoff<float>); }

/// Returns an absolute error in units of 2^-53, the roundoff of double.
inline double in_double_roundoffs(double error) { return std::abs(error) / kRoundoff<double>; }

} // namespace duet::compare

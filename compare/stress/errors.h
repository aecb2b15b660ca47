// Errors in the units that bounds are stated in. A result that is NaN has the error NaN: it fails any bound.
#pragma once

#include "common/vec/robust.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

/// The larger of two errors; NaN is larger than all.
inline double worse(double a, double b) { return std::isnan(a) || a > b ? a : b; }

/// |value − exact| in units in the last place of a T at `exact`: the distance of its neighbours in that binade.
template <typename T> double ulps(T value, long double exact) {
    int exponent = 0;
    std::frexp(exact, &exponent);                            // |exact| in [2^(exponent − 1), 2^exponent)
    const int lowest = std::numeric_limits<T>::min_exponent; // below it spacing is constant
    const long double ulp = std::ldexp(1.0L, std::max(exponent, lowest) - std::numeric_limits<T>::digits);
    return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / ulp);
}

/// |value − exact| / |exact|; 0 where both are equal, 0 included.
inline double relative_error(double value, double exact) {
    return value == exact ? 0 : std::abs(value - exact) / std::abs(exact);
}

/// An absolute error in units of u = 2^-24, the bound of one rounding of a float near 1.
inline double in_roundoffs(double error) { return std::abs(error) / static_cast<double>(kRoundoff<float>); }

/// The same for double: in units of 2^-53.
inline double in_double_roundoffs(double error) { return std::abs(error) / kRoundoff<double>; }

} // namespace duet::compare

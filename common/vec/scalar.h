// This file defines scalar helpers. Templates call `select`, `min`, `max`, `sqrt`, `any` and `all` unqualified: name
// lookup finds the functions below for float and double, and xsimd's overloads for SIMD batches. The same source thus
// works for all three.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace duet {

inline constexpr double kPiDouble = 3.14159265358979323846;
inline constexpr float kPi = static_cast<float>(kPiDouble);
inline constexpr float kInvPi = static_cast<float>(1.0 / kPiDouble);
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// The largest float below 1 is the upper bound of samples in [0, 1).
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

template <typename T>
concept Arithmetic = std::is_arithmetic_v<T>;

/// MaskOf is the type of a condition on numbers of type T: bool, or a batch of one bool per lane. Conditions are
/// combined by `&` and `|`, which batches have, too.
template <typename T> using MaskOf = decltype(std::declval<T>() < std::declval<T>());
/// Returns whether the condition holds in any lane. A bool is a single lane.
constexpr bool any(bool condition) { return condition; }
/// Returns whether the condition holds in all lanes.
constexpr bool all(bool condition) { return condition; }
/// Returns whether the condition holds in no lane.
template <typename Mask> constexpr bool none_of(const Mask& condition) { return !any(condition); }

/// Returns a where the condition holds, else b. Both arguments are always evaluated.
template <Arithmetic T> constexpr T select(bool condition, T a, T b) { return condition ? a : b; }
/// Returns the smaller argument, and a where one is NaN.
template <Arithmetic T> constexpr T min(T a, T b) { return b < a ? b : a; }
/// Returns the larger argument, and a where one is NaN.
template <Arithmetic T> constexpr T max(T a, T b) { return a < b ? b : a; }
/// Returns the square root; NaN for a negative number.
template <Arithmetic T> inline T sqrt(T x) { return std::sqrt(x); }
/// Returns the absolute value.
template <Arithmetic T> inline T abs(T x) { return std::abs(x); }

/// Returns x².
template <typename T> constexpr T sqr(T x) { return x * x; }
/// Returns x limited to [low, high], where low <= high.
template <typename T> constexpr T clamp(T x, T low, T high) { return min(max(x, low), high); }
/// Interpolates linearly from a at t = 0 to b at t = 1. The result is exact at both ends.
template <typename T> constexpr T lerp(T a, T b, T t) { return (T(1) - t) * a + t * b; }
/// Returns the square root of max(x, 0). Use it for values that rounding may have made slightly negative.
template <typename T> T safe_sqrt(T x) { return sqrt(max(x, T(0))); }

/// Converts degrees to radians.
constexpr double radians(double degrees) { return degrees * (kPiDouble / 180.0); }
/// Converts radians to degrees.
constexpr double degrees(double radians) { return radians * (180.0 / kPiDouble); }

} // namespace duet

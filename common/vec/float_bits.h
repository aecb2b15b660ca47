// These functions compute whole logarithms and powers of two from the exponent bits of floats. T is float or a SIMD
// batch of floats.
#pragma once

#include "common/vec/simd.h"

#include <bit>
#include <cstdint>

namespace duet {
namespace detail {

using UintBatch = xsimd::batch<std::uint32_t>;

inline std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }
inline float float_of(std::uint32_t bits) { return std::bit_cast<float>(bits); }
inline UintBatch bits_of(const xsimd::batch<float>& x) { return xsimd::bitwise_cast<UintBatch>(x); }
inline xsimd::batch<float> float_of(const UintBatch& bits) { return xsimd::bitwise_cast<xsimd::batch<float>>(bits); }

/// The sum of kMantissaOffset and an integer in [0, 2^23) has that integer as its mantissa bits. kBias is the bias of a
/// float's exponent.
inline constexpr float kMantissaOffset = 0x1p23f, kBias = 127;

} // namespace detail

/// Returns ⌊log₂ x⌋ for a positive, normal x, and 128 for infinity. Other inputs give a meaningless result.
template <typename T> T floor_log2(T x) {
    using namespace detail;
    return float_of((bits_of(x) >> 23) | bits_of(T(kMantissaOffset))) - T(kMantissaOffset + kBias);
}

/// Returns 2ⁿ for an integer n in [−126, 127].
template <typename T> T power_of_two(T n) {
    using namespace detail;
    return float_of(bits_of(n + T(kMantissaOffset + kBias)) << 23);
}

} // namespace duet

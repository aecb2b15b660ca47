// Powers of two out of the parts of floats, for one number or a batch.
#pragma once

#include "common/vec/simd.h"

#include <bit>
#include <cstdint>

namespace duet {
namespace detail {

using Whole = xsimd::batch<std::uint32_t>;

inline std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }
inline float float_of(std::uint32_t bits) { return std::bit_cast<float>(bits); }
inline Whole bits_of(const xsimd::batch<float>& x) { return xsimd::bitwise_cast<Whole>(x); }
inline xsimd::batch<float> float_of(const Whole& bits) { return xsimd::bitwise_cast<xsimd::batch<float>>(bits); }

/// Whole numbers from 0 to 2^23 added to it are its mantissa.
inline constexpr float kShift = 0x1p23f, kBias = 127;

} // namespace detail

/// ⌊log₂ x⌋ of a positive, normal number; 128 of infinity.
template <typename T> T whole_log2(T x) {
    using namespace detail;
    return float_of((bits_of(x) >> 23) | bits_of(T(kShift))) - T(kShift + kBias);
}

/// 2ⁿ, n a whole number from −126 to 127.
template <typename T> T power_of_two(T n) {
    using namespace detail;
    return float_of(bits_of(n + T(kShift + kBias)) << 23);
}

/// Whether all or none of a batch's lanes are true; the same of a bool.
inline bool none_of_lanes(bool lane) { return !lane; }
inline bool none_of_lanes(const xsimd::batch_bool<float>& lanes) { return !xsimd::any(lanes); }

} // namespace duet

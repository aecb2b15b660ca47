// Powers of two out of the parts of doubles, for one number or a batch.
#pragma once

#include "common/vec/simd.h"

#include <bit>
#include <cstdint>

namespace duet {
namespace detail {

inline std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }
inline double double_of(std::uint64_t bits) { return std::bit_cast<double>(bits); }
inline xsimd::batch<std::uint64_t> bits_of(const DoubleBatch& x) { return xsimd::bitwise_cast<xsimd::batch<std::uint64_t>>(x); }
inline DoubleBatch double_of(const xsimd::batch<std::uint64_t>& bits) { return xsimd::bitwise_cast<DoubleBatch>(bits); }

/// Whole numbers from 0 to 2^52 added to it are its mantissa.
inline constexpr double kShift = 0x1p52, kBias = 1023;

} // namespace detail

/// ⌊log₂ x⌋ of a positive, normal number; 1024 of infinity.
template <typename T> T whole_log2(T x) {
    using namespace detail;
    return double_of((bits_of(x) >> 52) | bits_of(T(kShift))) - T(kShift + kBias);
}

/// 2ⁿ, n a whole number from −1022 to 1023.
template <typename T> T power_of_two(T n) {
    using namespace detail;
    return double_of(bits_of(n + T(kShift + kBias)) << 52);
}

/// Whether all or none of a batch's lanes are true; the same of a bool.
inline bool none_of_lanes(bool lane) { return !lane; }
inline bool none_of_lanes(const DoubleBatch::batch_bool_type& lanes) { return !xsimd::any(lanes); }

} // namespace duet

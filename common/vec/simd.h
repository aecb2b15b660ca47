// SIMD batches of floats, by xsimd: its types under our names, and what it lacks. Their min, max, select, sqrt and abs
// are found by name lookup from the project's templates, as scalar.h's are for numbers.
#pragma once

#include <cstddef>

// GCC 12 takes the deliberately undefined operands of its own AVX-512 functions for a mistake.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <xsimd/xsimd.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

namespace duet {

/// A batch of N floats: 4 on any x86-64, 8 with AVX.
template <std::size_t N> using FloatBatch = xsimd::make_sized_batch_t<float, N>;

/// The number of lanes in which floats are best worked on here: wider ones gain little on a hierarchy's boxes.
#if XSIMD_WITH_AVX
inline constexpr std::size_t kSimdLanes = 8;
#else
inline constexpr std::size_t kSimdLanes = 4;
#endif

/// The widest batches of floats, for work that fills them.
#if XSIMD_WITH_AVX512F
inline constexpr std::size_t kMaxSimdLanes = 16;
#else
inline constexpr std::size_t kMaxSimdLanes = kSimdLanes;
#endif

/// a·b + c, rounded once where the machine can (xsimd 8 has no such instruction of 16 lanes).
template <typename Arch>
xsimd::batch<float, Arch> fused(xsimd::batch<float, Arch> a, xsimd::batch<float, Arch> b, xsimd::batch<float, Arch> c) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(a) == 64) return _mm512_fmadd_ps(a, b, c);
#endif
    return xsimd::fma(a, b, c);
}

/// A bit for each lane that holds true, lane 0 the lowest.
template <typename Arch> unsigned lane_bits(xsimd::batch_bool<float, Arch> lanes) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(lanes) != 32 && sizeof(lanes) != 16) return static_cast<unsigned>(lanes.data);
#endif
#if XSIMD_WITH_AVX
    if constexpr (sizeof(lanes) == 32) return static_cast<unsigned>(_mm256_movemask_ps(lanes));
#endif
    if constexpr (sizeof(lanes) == 16) return static_cast<unsigned>(_mm_movemask_ps(lanes));
}

} // namespace duet

// SIMD batches of floats, by xsimd: its types under our names, and what it lacks. Their min, max, select, sqrt and abs
// are found by name lookup from the project's templates, as scalar.h's are for numbers.
#pragma once

#include <cstddef>
#include <xsimd/xsimd.hpp>

namespace duet {

/// A batch of N floats: 4 on any x86-64, 8 with AVX.
template <std::size_t N> using FloatBatch = xsimd::make_sized_batch_t<float, N>;

/// The number of lanes in which floats are best worked on here: wider ones gain little on a hierarchy's boxes.
#if XSIMD_WITH_AVX
inline constexpr std::size_t kSimdLanes = 8;
#else
inline constexpr std::size_t kSimdLanes = 4;
#endif

/// A bit for each lane that holds true, lane 0 the lowest.
template <typename Arch> unsigned lane_bits(xsimd::batch_bool<float, Arch> lanes) {
#if XSIMD_WITH_AVX
    if constexpr (sizeof(lanes) == 32) return static_cast<unsigned>(_mm256_movemask_ps(lanes));
#endif
    if constexpr (sizeof(lanes) == 16) return static_cast<unsigned>(_mm_movemask_ps(lanes));
}

} // namespace duet

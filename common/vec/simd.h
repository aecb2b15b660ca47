// SIMD batches of floats, by xsimd: its types under our names, and what it lacks. Their min, max, select, sqrt and abs
// are found by name lookup from the project's templates, as scalar.h's are for numbers.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

// GCC 12 takes the deliberately undefined operands of its own AVX-512 functions for a mistake.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
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

/// A batch of as many doubles as the machine works on at once.
using DoubleBatch = xsimd::batch<double>;
inline constexpr std::size_t kDoubleLanes = sizeof(DoubleBatch) / sizeof(double);

/// So many floats, as doubles.
inline DoubleBatch load_doubles(const float* from) {
#if XSIMD_WITH_AVX512F
    return _mm512_cvtps_pd(_mm256_loadu_ps(from));
#elif XSIMD_WITH_AVX
    return _mm256_cvtps_pd(_mm_loadu_ps(from));
#else
    return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
#endif
}
/// Stores them rounded to floats.
inline void store_floats(DoubleBatch batch, float* to) {
#if XSIMD_WITH_AVX512F
    _mm256_storeu_ps(to, _mm512_cvtpd_ps(batch));
#elif XSIMD_WITH_AVX
    _mm_storeu_ps(to, _mm256_cvtpd_ps(batch));
#else
    _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_castps_si128(_mm_cvtpd_ps(batch)));
#endif
}

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

inline unsigned lane_bits(DoubleBatch::batch_bool_type lanes) {
#if XSIMD_WITH_AVX512F
    return static_cast<unsigned>(lanes.data);
#elif XSIMD_WITH_AVX
    return static_cast<unsigned>(_mm256_movemask_pd(lanes));
#else
    return static_cast<unsigned>(_mm_movemask_pd(lanes));
#endif
}

/// A batch of floats to pick from.
template <typename Batch> struct Lanes {
    alignas(sizeof(Batch)) std::array<float, sizeof(Batch) / sizeof(float)> values;

    explicit Lanes(Batch batch) { batch.store_aligned(values.data()); }
    float operator[](std::size_t lane) const { return values[lane]; }
};

/// Stores the lanes of the batch whose bits are set, and leaves the others alone.
template <typename Arch> void store_lanes(xsimd::batch<float, Arch> batch, unsigned lanes, float* to) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(batch) == 64) return _mm512_mask_store_ps(to, static_cast<__mmask16>(lanes), batch);
#endif
    const Lanes values(batch);
    for (; lanes != 0; lanes &= lanes - 1) to[std::countr_zero(lanes)] = values[static_cast<std::size_t>(std::countr_zero(lanes))];
}
/// The same of one value.
template <std::size_t N> void store_lanes(std::uint32_t value, unsigned lanes, std::array<std::uint32_t, N>& to) {
#if XSIMD_WITH_AVX512F
    if constexpr (N == 16)
        return _mm512_mask_storeu_epi32(to.data(), static_cast<__mmask16>(lanes), _mm512_set1_epi32(static_cast<int>(value)));
#endif
    for (; lanes != 0; lanes &= lanes - 1) to[static_cast<std::size_t>(std::countr_zero(lanes))] = value;
}

/// Structure of arrays out of an array of structures: lanes[k][i] is the k-th of the eight numbers at rows[i].
template <std::size_t N> void transpose_rows(const std::array<const float*, N>& rows, std::array<std::array<float, N>, 8>& lanes) {
#if XSIMD_WITH_AVX
    // Eight rows at a time: pairs, fours, then halves are interleaved.
    static_assert(N % 8 == 0);
    for (std::size_t first = 0; first < N; first += 8) {
        std::array<FloatBatch<8>, 8> r, p;
        for (std::size_t i = 0; i < 8; ++i) r[i] = _mm256_loadu_ps(rows[first + i]);
        for (std::size_t i = 0; i < 8; i += 2) {
            p[i] = _mm256_unpacklo_ps(r[i], r[i + 1]);
            p[i + 1] = _mm256_unpackhi_ps(r[i], r[i + 1]);
        }
        for (std::size_t i = 0; i < 8; i += 4)
            for (std::size_t k = 0; k < 2; ++k) {
                r[i + 2 * k] = _mm256_shuffle_ps(p[i + k], p[i + k + 2], 0x44);
                r[i + 2 * k + 1] = _mm256_shuffle_ps(p[i + k], p[i + k + 2], 0xEE);
            }
        for (std::size_t k = 0; k < 4; ++k) {
            _mm256_storeu_ps(&lanes[k][first], _mm256_permute2f128_ps(r[k], r[k + 4], 0x20));
            _mm256_storeu_ps(&lanes[k + 4][first], _mm256_permute2f128_ps(r[k], r[k + 4], 0x31));
        }
    }
#else
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t k = 0; k < 8; ++k) lanes[k][i] = rows[i][k];
#endif
}

/// The least of the lanes; of NaN any may come out.
template <typename Arch> float lowest(xsimd::batch<float, Arch> lanes) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(lanes) == 64) return _mm512_reduce_min_ps(lanes);
#endif
#if XSIMD_WITH_AVX
    if constexpr (sizeof(lanes) == 32)
        return lowest(FloatBatch<4>(_mm_min_ps(_mm256_castps256_ps128(lanes), _mm256_extractf128_ps(lanes, 1))));
#endif
    if constexpr (sizeof(lanes) == 16) {
        const __m128 two = _mm_min_ps(lanes, _mm_movehl_ps(lanes, lanes));
        return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 1)));
    }
}
/// The greatest of the lanes.
template <typename Arch> float highest(xsimd::batch<float, Arch> lanes) { return -lowest(-lanes); }

} // namespace duet

// SIMD batches of floats, by xsimd: its types under our names, and what it lacks. Their min, max, select, sqrt and abs
// are found by name lookup from the project's templates, as scalar.h's are for numbers.
#pragma once

#include <array>
#include <bit>
#include <cmath>
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

/// a·b + c, rounded once where the machine can (xsimd 8 has no such instruction of 16 lanes, nor of 4).
template <typename Arch>
xsimd::batch<float, Arch> fused(xsimd::batch<float, Arch> a, xsimd::batch<float, Arch> b, xsimd::batch<float, Arch> c) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(a) == 64) return _mm512_fmadd_ps(a, b, c);
#endif
#if defined(__FMA__)
    if constexpr (sizeof(a) == 16) return _mm_fmadd_ps(a, b, c);
#endif
    return xsimd::fma(a, b, c);
}

/// c − a·b, likewise.
template <typename Arch>
xsimd::batch<float, Arch> fused_minus(xsimd::batch<float, Arch> a, xsimd::batch<float, Arch> b, xsimd::batch<float, Arch> c) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(a) == 64) return _mm512_fnmadd_ps(a, b, c);
#endif
    return fused(-a, b, c);
}

inline DoubleBatch fused(DoubleBatch a, DoubleBatch b, DoubleBatch c) {
#if XSIMD_WITH_AVX512F
    return _mm512_fmadd_pd(a, b, c);
#else
    return xsimd::fma(a, b, c);
#endif
}
/// The same of one number.
inline float fused(float a, float b, float c) {
#if defined(__FMA__)
    return std::fma(a, b, c);
#else
    return a * b + c;
#endif
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

/// The one number in the lower half of the lanes, the other in the upper half.
template <std::size_t N> FloatBatch<N> halves(float low, float high) {
#if XSIMD_WITH_AVX512F
    if constexpr (N == 16) return _mm512_mask_broadcastss_ps(_mm512_set1_ps(low), 0xFF00, _mm_set_ss(high));
#endif
    alignas(sizeof(FloatBatch<N>)) std::array<float, N> lanes;
    for (std::size_t i = 0; i < N; ++i) lanes[i] = i < N / 2 ? low : high;
    return FloatBatch<N>::load_aligned(lanes.data());
}
/// The same of whole numbers.
template <std::size_t N> xsimd::make_sized_batch_t<std::uint32_t, N> whole_halves(std::uint32_t low, std::uint32_t high) {
#if XSIMD_WITH_AVX512F
    if constexpr (N == 16)
        return _mm512_mask_set1_epi32(_mm512_set1_epi32(static_cast<int>(low)), 0xFF00, static_cast<int>(high));
#endif
    alignas(64) std::array<std::uint32_t, N> lanes;
    for (std::size_t i = 0; i < N; ++i) lanes[i] = i < N / 2 ? low : high;
    return xsimd::make_sized_batch_t<std::uint32_t, N>::load_aligned(lanes.data());
}
/// As many floats as fill the lanes once, or half as many twice.
template <std::size_t N, std::size_t M> FloatBatch<N> repeated(const std::array<float, M>& lanes) {
    static_assert(M == N || 2 * M == N);
    if constexpr (M == N) return FloatBatch<N>::load_aligned(lanes.data());
#if XSIMD_WITH_AVX512F
    if constexpr (M == 8) return _mm512_broadcast_f32x8(_mm256_load_ps(lanes.data()));
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
    for (; lanes != 0; lanes &= lanes - 1)
        to[std::countr_zero(lanes)] = values[static_cast<std::size_t>(std::countr_zero(lanes))];
}
/// The same of one value.
template <std::size_t N> void store_lanes(std::uint32_t value, unsigned lanes, std::array<std::uint32_t, N>& to) {
#if XSIMD_WITH_AVX512F
    if constexpr (N == 16)
        return _mm512_mask_storeu_epi32(to.data(), static_cast<__mmask16>(lanes),
                                        _mm512_set1_epi32(static_cast<int>(value)));
#endif
    for (; lanes != 0; lanes &= lanes - 1) to[static_cast<std::size_t>(std::countr_zero(lanes))] = value;
}

namespace detail {

/// Of each run of four lanes: a0 b0 a1 b1, and a2 b2 a3 b3.
inline FloatBatch<4> zip_low(FloatBatch<4> a, FloatBatch<4> b) { return _mm_unpacklo_ps(a, b); }
inline FloatBatch<4> zip_high(FloatBatch<4> a, FloatBatch<4> b) { return _mm_unpackhi_ps(a, b); }
/// a0 a1 b0 b1, and a2 a3 b2 b3.
inline FloatBatch<4> pair_low(FloatBatch<4> a, FloatBatch<4> b) { return _mm_movelh_ps(a, b); }
inline FloatBatch<4> pair_high(FloatBatch<4> a, FloatBatch<4> b) { return _mm_movehl_ps(b, a); }
#if XSIMD_WITH_AVX
inline FloatBatch<8> zip_low(FloatBatch<8> a, FloatBatch<8> b) { return _mm256_unpacklo_ps(a, b); }
inline FloatBatch<8> zip_high(FloatBatch<8> a, FloatBatch<8> b) { return _mm256_unpackhi_ps(a, b); }
inline FloatBatch<8> pair_low(FloatBatch<8> a, FloatBatch<8> b) { return _mm256_shuffle_ps(a, b, 0x44); }
inline FloatBatch<8> pair_high(FloatBatch<8> a, FloatBatch<8> b) { return _mm256_shuffle_ps(a, b, 0xEE); }
#endif
#if XSIMD_WITH_AVX512F
inline FloatBatch<16> zip_low(FloatBatch<16> a, FloatBatch<16> b) { return _mm512_unpacklo_ps(a, b); }
inline FloatBatch<16> zip_high(FloatBatch<16> a, FloatBatch<16> b) { return _mm512_unpackhi_ps(a, b); }
inline FloatBatch<16> pair_low(FloatBatch<16> a, FloatBatch<16> b) { return _mm512_shuffle_ps(a, b, 0x44); }
inline FloatBatch<16> pair_high(FloatBatch<16> a, FloatBatch<16> b) { return _mm512_shuffle_ps(a, b, 0xEE); }
#endif

/// Four numbers at each of N / 4 places, one after the other.
template <std::size_t N, typename At> FloatBatch<N> gather_fours(const At& at) {
    const auto four = [&](std::size_t i) { return _mm_loadu_ps(at(i)); };
#if XSIMD_WITH_AVX512F
    if constexpr (N == 16)
        return _mm512_insertf32x4(
            _mm512_insertf32x4(_mm512_insertf32x4(_mm512_castps128_ps512(four(0)), four(1), 1), four(2), 2), four(3),
            3);
#endif
#if XSIMD_WITH_AVX
    if constexpr (N == 8) return _mm256_insertf128_ps(_mm256_castps128_ps256(four(0)), four(1), 1);
#endif
    if constexpr (N == 4) return four(0);
}
/// The i-th run of four lanes.
template <int i> FloatBatch<4> four(FloatBatch<4> lanes) { return lanes; }
#if XSIMD_WITH_AVX
template <int i> FloatBatch<4> four(FloatBatch<8> lanes) { return _mm256_extractf128_ps(lanes, i); }
#endif
#if XSIMD_WITH_AVX512F
template <int i> FloatBatch<4> four(FloatBatch<16> lanes) { return _mm512_extractf32x4_ps(lanes, i); }
#endif
/// The runs of four lanes, each to its place.
template <typename Batch, typename At> void scatter_fours(Batch fours, const At& at) {
    four<0>(fours).store_unaligned(at(0));
    if constexpr (sizeof(Batch) >= 32) four<1>(fours).store_unaligned(at(1));
    if constexpr (sizeof(Batch) == 64) {
        four<2>(fours).store_unaligned(at(2));
        four<3>(fours).store_unaligned(at(3));
    }
}

/// Rows become columns in each run of four lanes: of four batches, the k-th gets what was the k-th of four in all.
template <typename Batch> std::array<Batch, 4> transpose_fours(const std::array<Batch, 4>& r) {
    const Batch a = zip_low(r[0], r[1]), b = zip_low(r[2], r[3]), c = zip_high(r[0], r[1]), d = zip_high(r[2], r[3]);
    return {pair_low(a, b), pair_high(a, b), pair_low(c, d), pair_high(c, d)};
}

} // namespace detail

/// Structure of arrays out of an array of structures: lane i of the k-th batch is the k-th of four numbers at row(i).
template <std::size_t N, typename Row> std::array<FloatBatch<N>, 4> load_columns(const Row& row) {
    std::array<FloatBatch<N>, 4> rows;
    for (std::size_t k = 0; k < 4; ++k)
        rows[k] = detail::gather_fours<N>([&](std::size_t i) { return row(4 * i + k); });
    return detail::transpose_fours(rows);
}
/// And back.
template <std::size_t N, typename Row> void store_columns(const std::array<FloatBatch<N>, 4>& columns, const Row& row) {
    const std::array<FloatBatch<N>, 4> rows = detail::transpose_fours(columns);
    for (std::size_t k = 0; k < 4; ++k) detail::scatter_fours(rows[k], [&](std::size_t i) { return row(4 * i + k); });
}

/// The least of each batch's lanes, side by side: cheaper than one by one. Of NaN any may come out.
template <typename Batch> FloatBatch<4> lowest_of_each(const std::array<Batch, 4>& batches) {
    const auto [a, b, c, d] = detail::transpose_fours(batches);
    const Batch fours = xsimd::min(xsimd::min(a, b), xsimd::min(c, d));
    FloatBatch<4> result = detail::four<0>(fours);
    if constexpr (sizeof(Batch) >= 32) result = xsimd::min(result, detail::four<1>(fours));
    if constexpr (sizeof(Batch) == 64)
        result = xsimd::min(result, xsimd::min(detail::four<2>(fours), detail::four<3>(fours)));
    return result;
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

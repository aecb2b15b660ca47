// This file names xsimd's SIMD batch types and adds operations that xsimd lacks. The project's templates find xsimd's
// min, max, select, sqrt and abs by argument-dependent lookup, and those of scalar.h for single numbers.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

// GCC 12 warns about the deliberately undefined operands in its own AVX-512 intrinsics.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <xsimd/xsimd.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#if !XSIMD_WITH_SSE4_2 || (XSIMD_WITH_AVX && !(XSIMD_WITH_AVX2 && defined(__FMA__)))
#error "Duet has code for SSE4.2, AVX2 with fused multiply-add, and AVX-512: set DUET_ARCH to x86-64-v2, -v3 or -v4"
#endif

namespace duet {

/// A batch holds N floats. N may be 4, 8 with AVX2, and 16 with AVX-512.
template <std::size_t N> using FloatBatch = xsimd::make_sized_batch_t<float, N>;

/// The default number of float lanes is at most 8, because wider batches gain little in tests against BVH boxes.
#if XSIMD_WITH_AVX2
inline constexpr std::size_t kSimdLanes = 8;
#else
inline constexpr std::size_t kSimdLanes = 4;
#endif

/// The largest number of float lanes of the target CPU pays off only for work that fills all lanes.
#if XSIMD_WITH_AVX512F
inline constexpr std::size_t kMaxSimdLanes = 16;
#else
inline constexpr std::size_t kMaxSimdLanes = kSimdLanes;
#endif

/// A batch of doubles fills the widest SIMD register of the target CPU.
using DoubleBatch = xsimd::batch<double>;
inline constexpr std::size_t kDoubleLanes = sizeof(DoubleBatch) / sizeof(double);

/// A narrow batch has as many float lanes as a DoubleBatch has lanes. With SSE4.2, which has no batch of two floats,
/// its upper two lanes are 0 and mean nothing.
using NarrowBatch = FloatBatch<kDoubleLanes == 2 ? 4 : kDoubleLanes>;

/// Widens each lane to double, which is exact.
inline DoubleBatch to_doubles(NarrowBatch floats) {
#if XSIMD_WITH_AVX512F
    return _mm512_cvtps_pd(floats);
#elif XSIMD_WITH_AVX2
    return _mm256_cvtps_pd(floats);
#else
    return _mm_cvtps_pd(floats);
#endif
}
/// Rounds each lane to float.
inline NarrowBatch to_floats(DoubleBatch doubles) {
#if XSIMD_WITH_AVX512F
    return _mm512_cvtpd_ps(doubles);
#elif XSIMD_WITH_AVX2
    return _mm256_cvtpd_ps(doubles);
#else
    return _mm_cvtpd_ps(doubles);
#endif
}
/// Loads kDoubleLanes floats and converts them to doubles. The address needs no alignment.
inline DoubleBatch load_doubles(const float* from) {
#if XSIMD_WITH_AVX2
    return to_doubles(NarrowBatch::load_unaligned(from));
#else
    return to_doubles(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
#endif
}
/// Rounds the doubles to floats and stores kDoubleLanes of them. The address needs no alignment.
inline void store_floats(DoubleBatch batch, float* to) {
#if XSIMD_WITH_AVX2
    to_floats(batch).store_unaligned(to);
#else
    _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_castps_si128(to_floats(batch)));
#endif
}

/// The CPU has fused multiply-add. Without it, multiply_add() and negated_multiply_add() round the product, too.
#if defined(__FMA__)
inline constexpr bool kFusedMultiplyAdd = true;
#else
inline constexpr bool kFusedMultiplyAdd = false;
#endif

/// Returns a·b + c, rounded once where the CPU can. The intrinsics are needed because version 8 of xsimd rounds twice
/// for 16 or 4 lanes.
template <typename Arch>
xsimd::batch<float, Arch> multiply_add(xsimd::batch<float, Arch> a, xsimd::batch<float, Arch> b,
                                       xsimd::batch<float, Arch> c) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(a) == 64) return _mm512_fmadd_ps(a, b, c);
#endif
#if defined(__FMA__)
    if constexpr (sizeof(a) == 16) return _mm_fmadd_ps(a, b, c);
    return xsimd::fma(a, b, c);
#else
    return a * b + c;
#endif
}

/// Returns c − a·b, rounded once where the CPU can.
template <typename Arch>
xsimd::batch<float, Arch> negated_multiply_add(xsimd::batch<float, Arch> a, xsimd::batch<float, Arch> b,
                                               xsimd::batch<float, Arch> c) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(a) == 64) return _mm512_fnmadd_ps(a, b, c);
#endif
    return multiply_add(-a, b, c);
}

inline DoubleBatch multiply_add(DoubleBatch a, DoubleBatch b, DoubleBatch c) {
#if XSIMD_WITH_AVX512F
    return _mm512_fmadd_pd(a, b, c);
#elif defined(__FMA__)
    return xsimd::fma(a, b, c);
#else
    return a * b + c;
#endif
}
inline float multiply_add(float a, float b, float c) { return kFusedMultiplyAdd ? std::fma(a, b, c) : a * b + c; }

/// Returns a·b − c·d, which cancels where the products are close: at most one product is rounded. Without fused
/// multiply-add the computation is in double, where products of floats are exact.
inline float product_difference(float a, float b, float c, float d) {
    if constexpr (kFusedMultiplyAdd) return multiply_add(a, b, -(c * d));
    return static_cast<float>(static_cast<double>(a) * static_cast<double>(b) -
                              static_cast<double>(c) * static_cast<double>(d));
}
template <typename Arch>
xsimd::batch<float, Arch> product_difference(xsimd::batch<float, Arch> a, xsimd::batch<float, Arch> b,
                                             xsimd::batch<float, Arch> c, xsimd::batch<float, Arch> d) {
#if defined(__FMA__)
    return multiply_add(a, b, -(c * d));
#else
    const DoubleBatch low = to_doubles(a) * to_doubles(b) - to_doubles(c) * to_doubles(d);
    const auto high = [](__m128 lanes) { return to_doubles(NarrowBatch(_mm_movehl_ps(lanes, lanes))); };
    return _mm_movelh_ps(to_floats(low), to_floats(high(a) * high(b) - high(c) * high(d)));
#endif
}

/// Returns a bit mask of the lanes that are true. Bit i belongs to lane i.
template <typename Arch> unsigned lane_bits(xsimd::batch_bool<float, Arch> lanes) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(lanes) != 32 && sizeof(lanes) != 16) return static_cast<unsigned>(lanes.data);
#endif
#if XSIMD_WITH_AVX2
    if constexpr (sizeof(lanes) == 32) return static_cast<unsigned>(_mm256_movemask_ps(lanes));
#endif
    if constexpr (sizeof(lanes) == 16) return static_cast<unsigned>(_mm_movemask_ps(lanes));
}

inline unsigned lane_bits(DoubleBatch::batch_bool_type lanes) {
#if XSIMD_WITH_AVX512F
    return static_cast<unsigned>(lanes.data);
#elif XSIMD_WITH_AVX2
    return static_cast<unsigned>(_mm256_movemask_pd(lanes));
#else
    return static_cast<unsigned>(_mm_movemask_pd(lanes));
#endif
}

/// Returns a batch with `low` in the lower half of the lanes and `high` in the upper half.
template <std::size_t N> FloatBatch<N> halves(float low, float high) {
#if XSIMD_WITH_AVX512F
    if constexpr (N == 16) return _mm512_mask_broadcastss_ps(_mm512_set1_ps(low), 0xFF00, _mm_set_ss(high));
#endif
    alignas(sizeof(FloatBatch<N>)) std::array<float, N> lanes;
    for (std::size_t i = 0; i < N; ++i) lanes[i] = i < N / 2 ? low : high;
    return FloatBatch<N>::load_aligned(lanes.data());
}
/// Loads M floats into N lanes. Where M = N / 2, both halves of the batch receive the same floats.
template <std::size_t N, std::size_t M> FloatBatch<N> repeated(const std::array<float, M>& lanes) {
    static_assert(M == N || 2 * M == N);
    if constexpr (M == N) return FloatBatch<N>::load_aligned(lanes.data());
#if XSIMD_WITH_AVX512F
    if constexpr (M == 8) return _mm512_broadcast_f32x8(_mm256_load_ps(lanes.data()));
#endif
}

/// Stores a batch of floats in memory, so that single lanes can be read.
template <typename Batch> struct Lanes {
    alignas(sizeof(Batch)) std::array<float, sizeof(Batch) / sizeof(float)> values;

    explicit Lanes(Batch batch) { batch.store_aligned(values.data()); }
    float operator[](std::size_t lane) const { return values[lane]; }
};

/// This range consists of the indices of the bits that are set in a mask, from the lowest on. Its use is
/// `for (const std::size_t lane : SetBits(mask))`.
class SetBits {
public:
    constexpr explicit SetBits(unsigned mask) : mask_(mask) {}

    constexpr SetBits begin() const { return *this; }
    constexpr SetBits end() const { return SetBits(0); }
    constexpr std::size_t operator*() const { return static_cast<std::size_t>(std::countr_zero(mask_)); }
    constexpr SetBits& operator++() {
        mask_ &= mask_ - 1;
        return *this;
    }
    constexpr bool operator==(const SetBits&) const = default;

private:
    unsigned mask_;
};

/// Stores each lane of the batch whose bit is set in `lanes`: lane i goes to to[i]. The other floats at `to` stay
/// unchanged.
template <typename Arch> void store_lanes(xsimd::batch<float, Arch> batch, unsigned lanes, float* to) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(batch) == 64) return _mm512_mask_store_ps(to, static_cast<__mmask16>(lanes), batch);
#endif
    const Lanes values(batch);
    for (const std::size_t lane : SetBits(lanes)) to[lane] = values[lane];
}
/// Stores `value` in to[i] for each bit i that is set in `lanes`. The other elements stay unchanged.
template <std::size_t N> void store_lanes(std::uint32_t value, unsigned lanes, std::array<std::uint32_t, N>& to) {
#if XSIMD_WITH_AVX512F
    if constexpr (N == 16)
        return _mm512_mask_storeu_epi32(to.data(), static_cast<__mmask16>(lanes),
                                        _mm512_set1_epi32(static_cast<int>(value)));
#endif
    for (const std::size_t lane : SetBits(lanes)) to[lane] = value;
}

namespace detail {

/// In each group of four lanes, zip_low returns a0 b0 a1 b1, and zip_high returns a2 b2 a3 b3.
inline FloatBatch<4> zip_low(FloatBatch<4> a, FloatBatch<4> b) { return _mm_unpacklo_ps(a, b); }
inline FloatBatch<4> zip_high(FloatBatch<4> a, FloatBatch<4> b) { return _mm_unpackhi_ps(a, b); }
/// In each group of four lanes, pair_low returns a0 a1 b0 b1, and pair_high returns a2 a3 b2 b3.
inline FloatBatch<4> pair_low(FloatBatch<4> a, FloatBatch<4> b) { return _mm_movelh_ps(a, b); }
inline FloatBatch<4> pair_high(FloatBatch<4> a, FloatBatch<4> b) { return _mm_movehl_ps(b, a); }
#if XSIMD_WITH_AVX2
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

/// Loads four floats from each of the N / 4 addresses at(0), at(1), …: group i of four lanes receives those at at(i).
template <std::size_t N, typename At> FloatBatch<N> gather_fours(const At& at) {
    const auto four = [&](std::size_t i) { return _mm_loadu_ps(at(i)); };
#if XSIMD_WITH_AVX512F
    if constexpr (N == 16)
        return _mm512_insertf32x4(
            _mm512_insertf32x4(_mm512_insertf32x4(_mm512_castps128_ps512(four(0)), four(1), 1), four(2), 2), four(3),
            3);
#endif
#if XSIMD_WITH_AVX2
    if constexpr (N == 8) return _mm256_insertf128_ps(_mm256_castps128_ps256(four(0)), four(1), 1);
#endif
    if constexpr (N == 4) return four(0);
}
/// Returns the i-th group of four lanes.
template <int i> FloatBatch<4> four(FloatBatch<4> lanes) { return lanes; }
#if XSIMD_WITH_AVX2
template <int i> FloatBatch<4> four(FloatBatch<8> lanes) { return _mm256_extractf128_ps(lanes, i); }
#endif
#if XSIMD_WITH_AVX512F
template <int i> FloatBatch<4> four(FloatBatch<16> lanes) { return _mm512_extractf32x4_ps(lanes, i); }
#endif
/// Stores each group of four lanes: group i goes to the address at(i).
template <typename Batch, typename At> void scatter_fours(Batch fours, const At& at) {
    four<0>(fours).store_unaligned(at(0));
    if constexpr (sizeof(Batch) >= 32) four<1>(fours).store_unaligned(at(1));
    if constexpr (sizeof(Batch) == 64) {
        four<2>(fours).store_unaligned(at(2));
        four<3>(fours).store_unaligned(at(3));
    }
}

/// Transposes the 4 × 4 block that each group of four lanes forms across the four batches: lane j of result k is lane
/// k of input j.
template <typename Batch> std::array<Batch, 4> transpose_fours(const std::array<Batch, 4>& r) {
    const Batch a = zip_low(r[0], r[1]), b = zip_low(r[2], r[3]), c = zip_high(r[0], r[1]), d = zip_high(r[2], r[3]);
    return {pair_low(a, b), pair_high(a, b), pair_low(c, d), pair_high(c, d)};
}

} // namespace detail

/// Loads an array of structures as a structure of arrays: lane i of batch k is the float at row(i)[k], for k in [0, 4).
template <std::size_t N, typename Row> std::array<FloatBatch<N>, 4> load_columns(const Row& row) {
    std::array<FloatBatch<N>, 4> rows;
    for (std::size_t k = 0; k < 4; ++k)
        rows[k] = detail::gather_fours<N>([&](std::size_t i) { return row(4 * i + k); });
    return detail::transpose_fours(rows);
}
/// Stores a structure of arrays as an array of structures: lane i of batch k goes to row(i)[k], for k in [0, 4).
template <std::size_t N, typename Row> void store_columns(const std::array<FloatBatch<N>, 4>& columns, const Row& row) {
    const std::array<FloatBatch<N>, 4> rows = detail::transpose_fours(columns);
    for (std::size_t k = 0; k < 4; ++k) detail::scatter_fours(rows[k], [&](std::size_t i) { return row(4 * i + k); });
}

/// Returns the smallest lane of each of the four batches: lane k of the result belongs to batch k. This costs less than
/// four calls of lowest(). The result is unspecified for a batch that contains NaN.
template <typename Batch> FloatBatch<4> reduce_min_of_each(const std::array<Batch, 4>& batches) {
    const auto [a, b, c, d] = detail::transpose_fours(batches);
    const Batch fours = xsimd::min(xsimd::min(a, b), xsimd::min(c, d));
    FloatBatch<4> result = detail::four<0>(fours);
    if constexpr (sizeof(Batch) >= 32) result = xsimd::min(result, detail::four<1>(fours));
    if constexpr (sizeof(Batch) == 64)
        result = xsimd::min(result, xsimd::min(detail::four<2>(fours), detail::four<3>(fours)));
    return result;
}

/// Returns the smallest lane. The result is unspecified if a lane is NaN.
template <typename Arch> float reduce_min(xsimd::batch<float, Arch> lanes) {
#if XSIMD_WITH_AVX512F
    if constexpr (sizeof(lanes) == 64) return _mm512_reduce_min_ps(lanes);
#endif
#if XSIMD_WITH_AVX2
    if constexpr (sizeof(lanes) == 32)
        return reduce_min(FloatBatch<4>(_mm_min_ps(_mm256_castps256_ps128(lanes), _mm256_extractf128_ps(lanes, 1))));
#endif
    if constexpr (sizeof(lanes) == 16) {
        const __m128 two = _mm_min_ps(lanes, _mm_movehl_ps(lanes, lanes));
        return _mm_cvtss_f32(_mm_min_ss(two, _mm_shuffle_ps(two, two, 1)));
    }
}
/// Returns the largest lane. The result is unspecified if a lane is NaN.
template <typename Arch> float reduce_max(xsimd::batch<float, Arch> lanes) { return -reduce_min(-lanes); }

} // namespace duet

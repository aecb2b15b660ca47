// Implements the rasterizer's SIMD helpers. The rasterizer processes packets of 16 samples in batches as wide as the
// CPU supports (common/vec/simd.h).
#pragma once

#include "common/vec/simd.h"
#include "common/vec/vec.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace duet::raster {

using Floats = xsimd::batch<float>;
using Ints = xsimd::batch<std::int32_t>;
using Doubles = xsimd::batch<double>;

/// A packet has 16 samples: two rows of a block of 8 × 8 (raster/visibility/depth_tile.h).
inline constexpr std::size_t kPacketSize = 16, kPacketWidth = 8;
static_assert(kPacketSize % Floats::size == 0 && Floats::size == Ints::size);

/// Prefetches the cache line of an address that will be read soon.
inline void prefetch(const void* address) {
    __builtin_prefetch(address);
    asm volatile(""); // else GCC considers functions that only prefetch empty and removes calls to them
}

/// Stores one value per sample of a packet. It is uninitialized, because clearing takes longer than some of the
/// computations.
template <typename T> struct alignas(64) PacketOf {
    std::array<T, kPacketSize> v;

    T& operator[](std::size_t i) { return v[i]; }
    const T& operator[](std::size_t i) const { return v[i]; }
    void fill(T x) { v.fill(x); }
    T* at(std::size_t i) { return v.data() + i; }
    const T* at(std::size_t i) const { return v.data() + i; }
};

/// Loads one batch of values from the i-th on.
template <typename T> xsimd::batch<T> load(const PacketOf<T>& packet, std::size_t i) {
    return xsimd::batch<T>::load_aligned(packet.at(i));
}
/// Stores one batch of values from the i-th on.
template <typename T> void store(PacketOf<T>& packet, std::size_t i, const xsimd::batch<T>& value) {
    value.store_aligned(packet.at(i));
}

static_assert(Floats::size == 2 * Doubles::size);

/// Stores one batch of doubles in a packet of doubles or floats, rounded if needed.
inline void store_rounded(PacketOf<double>& packet, std::size_t i, const Doubles& value) { store(packet, i, value); }
inline void store_rounded(PacketOf<float>& packet, std::size_t i, const Doubles& value) {
    store_floats(value, packet.at(i));
}

using duet::multiply_add;
using duet::negated_multiply_add;

/// Writes a cache line from two halves with non-temporal stores. They do not evict data that is needed sooner, and
/// do not fetch the line before overwriting it. Other threads see the data after finish_streams().
inline void stream_line(const void* first_half, const void* second_half, void* line) {
#ifdef DUET_SANITIZED // sanitizers do not support non-temporal stores
    std::memcpy(line, first_half, 32);
    std::memcpy(static_cast<char*>(line) + 32, second_half, 32);
#elif defined(__AVX__)
    const __m256i first = _mm256_loadu_si256(static_cast<const __m256i*>(first_half)),
                  second = _mm256_loadu_si256(static_cast<const __m256i*>(second_half));
#if defined(__AVX512F__)
    _mm512_stream_si512(static_cast<__m512i*>(line), _mm512_inserti64x4(_mm512_castsi256_si512(first), second, 1));
#else
    _mm256_stream_si256(static_cast<__m256i*>(line), first);
    _mm256_stream_si256(static_cast<__m256i*>(line) + 1, second);
#endif
#else
    const auto *first = static_cast<const __m128i*>(first_half), *second = static_cast<const __m128i*>(second_half);
    auto* to = static_cast<__m128i*>(line);
    for (int i = 0; i < 2; ++i) _mm_stream_si128(to + i, _mm_loadu_si128(first + i));
    for (int i = 0; i < 2; ++i) _mm_stream_si128(to + 2 + i, _mm_loadu_si128(second + i));
#endif
}
/// Makes the data of earlier calls of stream_line visible before any later store.
inline void finish_streams() { _mm_sfence(); }
/// Returns whether an address begins a cache line of 64 bytes.
inline bool is_line_start(const void* address) { return reinterpret_cast<std::uintptr_t>(address) % 64 == 0; }

/// Returns the dot products of one batch of vectors.
inline Floats dot(const Vec3T<Floats>& a, const Vec3T<Floats>& b) {
    return multiply_add(a.x, b.x, multiply_add(a.y, b.y, Floats(a.z * b.z)));
}

/// Converts doubles to floats: the lanes of `low`, then those of `high`. (xsimd has no such conversion. Converting
/// through memory would stall, because the wide load would wait for several narrow stores.)
inline Floats narrowed(const Doubles& low, const Doubles& high) {
#if defined(__AVX512F__)
    return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(_mm512_cvtpd_ps(low))),
                                               _mm256_castps_pd(_mm512_cvtpd_ps(high)), 1));
#elif defined(__AVX__)
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(low)), _mm256_cvtpd_ps(high), 1);
#else
    return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
#endif
}

/// Rounds doubles to float precision.
inline Doubles round_to_float(const Doubles& value) { return to_doubles(to_floats(value)); }

/// Converts doubles with integer values to 32-bit integers and stores them.
inline void store_ints(const Doubles& value, std::int32_t* to) {
#if defined(__AVX512F__)
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm512_cvtpd_epi32(value));
#elif defined(__AVX__)
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm256_cvtpd_epi32(value));
#else
    _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_cvtpd_epi32(value));
#endif
}

/// Returns 1/√x of each lane, x > 0: the CPU's estimate and one Newton step, within a few units in the last place.
inline Floats inverse_sqrt(const Floats& x) {
#if defined(__AVX512F__)
    const Floats y = _mm512_rsqrt14_ps(x); // xsimd 8's own function selects no instruction here
#else
    const Floats y = xsimd::rsqrt(x);
#endif
    return y * negated_multiply_add(Floats(0.5f) * x * y, y, Floats(1.5f));
}

/// Returns 1/√x of a single value, x > 0.
inline float inverse_sqrt(float x) { return 1 / std::sqrt(x); }

using Quads = FloatBatch<4>;

/// Loads three floats and sets the fourth to 0. Memory beyond the three is not read.
inline Quads load_three(const float* from) {
#if defined(__AVX512VL__)
    return _mm_maskz_loadu_ps(7, from);
#elif defined(__AVX__)
    return _mm_maskload_ps(from, _mm_setr_epi32(-1, -1, -1, 0));
#else
    return _mm_movelh_ps(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))),
                         _mm_load_ss(from + 2));
#endif
}

/// Returns one bit per lane that is true; lane 0 is the lowest bit.
inline std::uint32_t lane_bits(const xsimd::batch_bool<std::int32_t>& lanes) {
#if defined(__AVX512F__)
    return static_cast<std::uint32_t>(static_cast<__mmask16>(lanes));
#elif defined(__AVX__)
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(lanes)));
#else
    return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(lanes)));
#endif
}

using duet::lane_bits; // for floats and doubles

/// Returns one bit per sample of a packet whose value equals `value`.
inline std::uint32_t lanes_equal(const PacketOf<std::int32_t>& packet, std::int32_t value) {
    std::uint32_t lanes = 0;
    for (std::size_t i = 0; i < kPacketSize; i += Ints::size) lanes |= lane_bits(load(packet, i) == Ints(value)) << i;
    return lanes;
}

/// Returns one bit per sample of a packet whose value does not occur at an earlier sample.
inline std::uint32_t first_occurrences(const PacketOf<std::int32_t>& packet) {
#if defined(__AVX512CD__)
    const __m512i before = _mm512_conflict_epi32(load(packet, 0)); // bits of the earlier lanes with an equal value
    return _mm512_testn_epi32_mask(before, before);
#else
    std::uint32_t firsts = 0;
    for (std::uint32_t left = (1u << kPacketSize) - 1; left != 0;) {
        const int i = std::countr_zero(left);
        firsts |= 1u << i;
        left &= ~lanes_equal(packet, packet[static_cast<std::size_t>(i)]);
    }
    return firsts;
#endif
}

/// Returns a batch whose lanes are true where the bits are set; the inverse of lane_bits().
template <typename T> xsimd::batch_bool<T> lanes_from(std::uint32_t bits) {
#if defined(__AVX512F__)
    return typename xsimd::batch_bool<T>::register_type(bits);
#else
    using Integer = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
    using Lanes = xsimd::batch<Integer>;
    alignas(64) static constexpr auto kBits = [] {
        std::array<Integer, Lanes::size> each{};
        for (std::size_t i = 0; i < each.size(); ++i) each[i] = Integer{1} << i;
        return each;
    }();
    return xsimd::bool_cast((Lanes(static_cast<Integer>(bits)) & Lanes::load_aligned(kBits.data())) !=
                            Lanes(Integer{0}));
#endif
}

/// Calls use(value, lanes) for each value that the keys have in the lanes `left`. `lanes` are those of `left` with that
/// value.
template <typename T, typename Use>
void for_each_value(const xsimd::batch<T>& keys, std::uint32_t left, const Use& use) {
    alignas(64) std::array<T, xsimd::batch<T>::size> each;
    keys.store_aligned(each.data());
    while (left != 0) {
        const T value = each[static_cast<std::size_t>(std::countr_zero(left))];
        const std::uint32_t own = (lane_bits(keys == xsimd::batch<T>(value)) & left) | (left & -left); // NaN is unequal
        left &= ~own;
        use(value, lanes_from<float>(own));
    }
}

/// Returns the column of each sample of a packet.
template <typename T> PacketOf<T> packet_columns() {
    PacketOf<T> result;
    for (std::size_t i = 0; i < kPacketSize; ++i) result[i] = static_cast<T>(i % kPacketWidth);
    return result;
}
/// Returns the row of each sample of a packet.
template <typename T> PacketOf<T> packet_rows() {
    PacketOf<T> result;
    for (std::size_t i = 0; i < kPacketSize; ++i) result[i] = static_cast<T>(i / kPacketWidth);
    return result;
}
template <typename T> inline const PacketOf<T> kColumns = packet_columns<T>();
template <typename T> inline const PacketOf<T> kRows = packet_rows<T>();

/// Gathers one batch of values at the given indices of an array.
inline Floats gather(const float* from, const Ints& indices) {
#if defined(__AVX512F__)
    return _mm512_i32gather_ps(indices, from, 4);
#elif defined(__AVX2__)
    return _mm256_i32gather_ps(from, indices, 4);
#else
    alignas(64) std::array<std::int32_t, Ints::size> at;
    alignas(64) std::array<float, Ints::size> result;
    indices.store_aligned(at.data());
    for (std::size_t i = 0; i < Ints::size; ++i) result[i] = from[at[i]];
    return Floats::load_aligned(result.data());
#endif
}
inline Ints gather(const std::int32_t* from, const Ints& indices) {
    alignas(64) std::array<std::int32_t, Ints::size> values;
    indices.store_aligned(values.data());
    for (std::int32_t& value : values) value = from[value];
    return Ints::load_aligned(values.data());
}
/// Truncates toward zero.
inline Ints truncated(const Floats& x) { return xsimd::batch_cast<std::int32_t>(x); }

/// This constant holds the index of each sample of a packet.
inline const PacketOf<std::int32_t> kLanes = [] {
    PacketOf<std::int32_t> result;
    for (std::size_t i = 0; i < kPacketSize; ++i) result[i] = static_cast<std::int32_t>(i);
    return result;
}();

/// This constant holds the index of each sample of a packet as a float.
inline const PacketOf<float> kLanesAsFloats = [] {
    PacketOf<float> result;
    for (std::size_t i = 0; i < kPacketSize; ++i) result[i] = static_cast<float>(i);
    return result;
}();

/// This constant holds the index of each lane of a batch of doubles.
inline const Doubles kLanesAsDoubles = [] {
    alignas(64) std::array<double, Doubles::size> result;
    for (std::size_t i = 0; i < Doubles::size; ++i) result[i] = static_cast<double>(i);
    return Doubles::load_aligned(result.data());
}();

} // namespace duet::raster

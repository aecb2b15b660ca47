// Implements table lookups with SIMD, in tables of as many values as a packet has samples.
#pragma once

#include "raster/geometry/packet.h"

namespace duet::raster {

/// Looks up values in a table of sixteen by the lower four bits of each index.
inline Floats look_up(const PacketOf<float>& table, const Ints& index) {
#if defined(__AVX512F__)
    return _mm512_permutexvar_ps(index, load(table, 0));
#elif defined(__AVX2__)
    return _mm256_blendv_ps(_mm256_permutevar8x32_ps(load(table, 0), index),
                            _mm256_permutevar8x32_ps(load(table, 8), index),
                            _mm256_castsi256_ps(_mm256_slli_epi32(index, 28)));
#else
    alignas(64) std::array<std::int32_t, Ints::size> at;
    alignas(64) std::array<float, Floats::size> found;
    index.store_aligned(at.data());
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = table[static_cast<std::size_t>(at[i] & 15)];
    return Floats::load_aligned(found.data());
#endif
}
inline Floats look_up(const PacketOf<float>& table, const PacketOf<std::int32_t>& index, std::size_t i) {
    return look_up(table, load(index, i));
}
/// Looks up doubles by the indices from the i-th on.
inline Doubles look_up(const PacketOf<double>& table, const PacketOf<std::int32_t>& index, std::size_t i) {
#if defined(__AVX512F__)
    const __m512i at = _mm512_cvtepi32_epi64(_mm256_load_si256(reinterpret_cast<const __m256i*>(index.at(i))));
    return _mm512_permutex2var_pd(load(table, 0), at, load(table, 8));
#else
    alignas(64) std::array<double, Doubles::size> found;
    for (std::size_t k = 0; k < found.size(); ++k) found[k] = table[static_cast<std::size_t>(index[i + k] & 15)];
    return Doubles::load_aligned(found.data());
#endif
}

/// Looks up addresses and stores them in `found`. Indices must be below 16.
template <typename T>
void look_up(const std::array<const T*, kPacketSize>& table, const Ints& index,
             std::array<const T*, Ints::size>& found) {
#if defined(__AVX512F__)
    const __m512i first = _mm512_loadu_si512(table.data()), second = _mm512_loadu_si512(table.data() + kPacketSize / 2);
    const auto eight = [&](__m256i at) { return _mm512_permutex2var_epi64(first, _mm512_cvtepi32_epi64(at), second); };
    _mm512_storeu_si512(found.data(), eight(_mm512_castsi512_si256(index)));
    _mm512_storeu_si512(found.data() + kPacketSize / 2, eight(_mm512_extracti64x4_epi64(index, 1)));
#else
    alignas(64) std::array<std::int32_t, Ints::size> at;
    index.store_aligned(at.data());
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = table[static_cast<std::size_t>(at[i])];
#endif
}

/// Looks up values in two consecutive tables of sixteen by the lower five bits of each index.
inline Floats look_up(const PacketOf<float>& first, const PacketOf<float>& second, const Ints& index) {
#if defined(__AVX512F__)
    return _mm512_permutex2var_ps(load(first, 0), index, load(second, 0));
#elif defined(__AVX2__)
    return _mm256_blendv_ps(look_up(first, index), look_up(second, index),
                            _mm256_castsi256_ps(_mm256_slli_epi32(index, 27)));
#else
    alignas(64) std::array<std::int32_t, Ints::size> at;
    alignas(64) std::array<float, Floats::size> found;
    index.store_aligned(at.data());
    for (std::size_t k = 0; k < found.size(); ++k)
        found[k] = (at[k] & 16 ? second : first)[static_cast<std::size_t>(at[k] & 15)];
    return Floats::load_aligned(found.data());
#endif
}
/// Looks up values in two consecutive tables of sixteen by the indices from the i-th on.
inline Floats look_up(const PacketOf<float>& first, const PacketOf<float>& second, const PacketOf<std::int32_t>& index,
                      std::size_t i) {
    return look_up(first, second, load(index, i));
}
/// Looks up integers in two tables of sixteen; see above for floats.
inline Ints look_up(const PacketOf<std::int32_t>& first, const PacketOf<std::int32_t>& second,
                    const PacketOf<std::int32_t>& index, std::size_t i) {
#if defined(__AVX512F__)
    return _mm512_permutex2var_epi32(load(first, 0), load(index, i), load(second, 0));
#else
    alignas(64) std::array<std::int32_t, Ints::size> found;
    for (std::size_t k = 0; k < found.size(); ++k) {
        const auto at = static_cast<std::size_t>(index[i + k]);
        found[k] = (at & 16 ? second : first)[at & 15];
    }
    return Ints::load_aligned(found.data());
#endif
}
/// Looks up doubles in two tables of sixteen; see above for floats.
inline Doubles look_up(const PacketOf<double>& first, const PacketOf<double>& second,
                       const PacketOf<std::int32_t>& index, std::size_t i) {
#if defined(__AVX512F__)
    const __m512i at = _mm512_cvtepi32_epi64(_mm256_load_si256(reinterpret_cast<const __m256i*>(index.at(i))));
    return _mm512_mask_blend_pd(_mm512_test_epi64_mask(at, _mm512_set1_epi64(16)), look_up(first, index, i),
                                look_up(second, index, i));
#else
    alignas(64) std::array<double, Doubles::size> found;
    for (std::size_t k = 0; k < found.size(); ++k) {
        const auto at = static_cast<std::size_t>(index[i + k]);
        found[k] = (at & 16 ? second : first)[at & 15];
    }
    return Doubles::load_aligned(found.data());
#endif
}

} // namespace duet::raster

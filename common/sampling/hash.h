// This file defines integer hashes. All random numbers of the project come from them.
#pragma once

#include <cstdint>

namespace duet {

/// Mixes the bits of a 64-bit number. The function is a bijection in which each input bit flips each output bit with a
/// probability of about one half. It is the finalizer of MurmurHash3 with the constants of Stafford's variant 13, as in
/// SplitMix64 (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators", §5). 0 maps to 0.
constexpr std::uint64_t mix_bits(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// Mixes the bits of a 32-bit number. U is std::uint32_t or a SIMD batch of it. The constants of the two
/// multiplications are those with the least bias found by a search (Wellons 2018, "Prospecting for Hash Functions"). 0
/// maps to 0.
template <typename U> constexpr U mix_bits_32(U x) {
    x = (x ^ (x >> 16)) * U(0x7feb352du);
    x = (x ^ (x >> 15)) * U(0x846ca68bu);
    return x ^ (x >> 16);
}

/// The increment of SplitMix64's state is 2^64 divided by the golden ratio.
inline constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15u;
/// The increment of 32-bit streams is the upper half of kGoldenGamma.
inline constexpr std::uint32_t kGoldenGamma32 = 0x9e3779b9u;

/// Returns number i of the SplitMix64 stream that starts at `state`, which must already be well mixed. The cost is one
/// call of mix_bits, which suits inner loops.
constexpr std::uint64_t stream_number(std::uint64_t state, std::uint64_t i) {
    return mix_bits(state + (i + 1) * kGoldenGamma);
}

/// Returns a hash of a state and one more number, which need not be mixed. Calls can be chained, for example
/// hash_combine(hash_combine(seed, x), y).
constexpr std::uint64_t hash_combine(std::uint64_t state, std::uint64_t value) {
    return mix_bits((state + kGoldenGamma) ^ mix_bits(value + 0xd1b54a32d192ed03u));
}

/// Returns the upper 32 bits.
constexpr std::uint32_t high_bits(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }
/// Returns the lower 32 bits.
constexpr std::uint32_t low_bits(std::uint64_t x) { return static_cast<std::uint32_t>(x); }

/// Converts the upper 24 bits to a float in [0, 1). Each result is a multiple of 2^-24, and 1 is never reached. The
/// interval [k/2^m, (k+1)/2^m) receives exactly the numbers whose upper m bits are k, for m <= 24.
constexpr float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// Returns the image of i under a pseudorandom permutation of 0 … n−1 that `key` selects, for i < n and n >= 1. A
/// bijection of the numbers below the next power of two is applied until the result is below n (cycle walking; Kensler
/// 2013, "Correlated Multi-Jittered Sampling", §4, uses the same idea).
constexpr std::uint32_t permute(std::uint32_t i, std::uint32_t n, std::uint64_t key) {
    if (n <= 1) return 0;
    int bits = 1;
    while (bits < 32 && (n - 1) >> bits != 0) ++bits;
    const std::uint32_t mask = bits == 32 ? 0xffffffffu : (std::uint32_t{1} << bits) - 1;
    const int half = (bits + 1) / 2;
    // Each step is invertible modulo 2^bits: an odd multiple, an xor with higher bits only, and a sum.
    do {
        std::uint64_t round_key = key;
        for (int round = 0; round < 4; ++round) {
            round_key = mix_bits(round_key + kGoldenGamma);
            i = (i * (low_bits(round_key) | 1u)) & mask;
            i ^= i >> half;
            i = (i + high_bits(round_key)) & mask;
        }
    } while (i >= n);
    return i;
}

} // namespace duet

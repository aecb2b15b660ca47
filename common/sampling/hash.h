// Integer hashes: where every random number of the project comes from.
#pragma once

#include <cstdint>

namespace duet {

/// A bijection of 64-bit numbers in which each input bit flips each output bit with a chance of about one half: the
/// finalizer of MurmurHash3 with the constants of Stafford's variant 13, as in SplitMix64 (Steele, Lea and Flood 2014,
/// «Fast Splittable Pseudorandom Number Generators», §5). 0 maps to 0.
constexpr std::uint64_t mix_bits(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// The same of 32-bit numbers, U being std::uint32_t or a SIMD batch of them: two multiplications, by the constants of
/// least bias that a search found (Wellons 2018, «Prospecting for Hash Functions»). 0 maps to 0.
template <typename U> constexpr U mix_bits_32(U x) {
    x = (x ^ (x >> 16)) * U(0x7feb352du);
    x = (x ^ (x >> 15)) * U(0x846ca68bu);
    return x ^ (x >> 16);
}

/// 2^64 over the golden ratio: SplitMix64's step from state to state.
inline constexpr std::uint64_t kGoldenStep = 0x9e3779b97f4a7c15u;
/// Its upper half: the step of 32-bit streams.
inline constexpr std::uint32_t kGoldenStep32 = 0x9e3779b9u;

/// Number i of the SplitMix64 stream that begins at a well mixed `state`: one mix, for inner loops.
constexpr std::uint64_t stream_number(std::uint64_t state, std::uint64_t i) {
    return mix_bits(state + (i + 1) * kGoldenStep);
}

/// A hash of a state and one more number of any form, to be chained: hash_combine(hash_combine(seed, x), y).
constexpr std::uint64_t hash_combine(std::uint64_t state, std::uint64_t value) {
    return mix_bits((state + kGoldenStep) ^ mix_bits(value + 0xd1b54a32d192ed03u));
}

constexpr std::uint32_t high_bits(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }
constexpr std::uint32_t low_bits(std::uint64_t x) { return static_cast<std::uint32_t>(x); }

/// The upper 24 bits as a float in [0, 1): every value is a multiple of 2^-24, 1 is never reached, and intervals
/// [k/2^m, (k+1)/2^m) receive exactly the numbers whose upper m bits are k.
constexpr float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// The image of i under a pseudo-random permutation of 0 … n−1 chosen by `key`; i < n, n ≥ 1. A bijection of the
/// numbers below the next power of two, repeated until the image is below n (cycle walking; Kensler 2013,
/// «Correlated Multi-Jittered Sampling», §4, uses the same idea).
constexpr std::uint32_t permute(std::uint32_t i, std::uint32_t n, std::uint64_t key) {
    if (n <= 1) return 0;
    int bits = 1;
    while (bits < 32 && (n - 1) >> bits != 0) ++bits;
    const std::uint32_t mask = bits == 32 ? 0xffffffffu : (std::uint32_t{1} << bits) - 1;
    const int half = (bits + 1) / 2;
    do { // each step is invertible modulo 2^bits: an odd multiple, a sum, and a shift that only looks at higher bits
        std::uint64_t round_key = key;
        for (int round = 0; round < 4; ++round) {
            round_key = mix_bits(round_key + kGoldenStep);
            i = (i * (low_bits(round_key) | 1u)) & mask;
            i ^= i >> half;
            i = (i + high_bits(round_key)) & mask;
        }
    } while (i >= n);
    return i;
}

} // namespace duet

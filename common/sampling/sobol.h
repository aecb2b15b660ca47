// This file defines the first two dimensions of the Sobol sequence and their Owen scrambling.
//
// All functions work on binary digits in *reversed* order: bit 0 is the first digit after the point, of value ½, and
// bit 31 is the last. This order has three advantages. The index of a point equals its first coordinate (the van der
// Corput sequence). In Owen scrambling, each bit depends on lower bits only, as in an integer multiplication. The bits
// are reversed only once, at the end.
#pragma once

#include "common/vec/vec.h"

#include <cstdint>

namespace duet {

/// Reverses the order of the bits. In this file, U is std::uint32_t or a SIMD batch of it.
template <typename U> constexpr U reverse_bits(U x) {
    x = (x >> 16) | (x << 16);
    x = ((x & U(0x00ff00ffu)) << 8) | ((x >> 8) & U(0x00ff00ffu));
    x = ((x & U(0x0f0f0f0fu)) << 4) | ((x >> 4) & U(0x0f0f0f0fu));
    x = ((x & U(0x33333333u)) << 2) | ((x >> 2) & U(0x33333333u));
    return ((x & U(0x55555555u)) << 1) | ((x >> 1) & U(0x55555555u));
}

/// Returns the second coordinate of Sobol point `index`, with reversed digits. The first coordinate is the index
/// itself, and both together form a (0, 2)-sequence.
///
/// The generator matrix of the primitive polynomial x + 1 (Joe and Kuo 2008, dimension 2) is Pascal's triangle modulo
/// 2. By Lucas's theorem, binomial(j, i) is odd exactly where the bits of i are a subset of the bits of j. The product
/// of matrix and index is therefore a sum over supersets, which five shifts compute. A test compares the result with
/// the direction numbers.
template <typename U> constexpr U sobol_second(U index) {
    U x = index;
    x = x ^ ((x >> 1) & U(0x55555555u));
    x = x ^ ((x >> 2) & U(0x33333333u));
    x = x ^ ((x >> 4) & U(0x0f0f0f0fu));
    x = x ^ ((x >> 8) & U(0x00ff00ffu));
    return x ^ ((x >> 16) & U(0x0000ffffu));
}

/// Returns point `index` < n of the first n Sobol points, where n is a power of two up to 2^24. Each coordinate is
/// moved to the center of its interval of width 1/n. All n points form a (0, 2)-net, and so does each aligned block of
/// 2^k points.
inline Vec2 sobol_net_point(std::uint32_t index, int n) {
    const auto digits = [n](std::uint32_t reversed) {
        return static_cast<float>(reverse_bits(reversed)) * 0x1p-32f + 0.5f / static_cast<float>(n);
    };
    return {digits(index), digits(sobol_second(index))};
}

/// Applies nested uniform (Owen) scrambling to a number with reversed digits. Each seed gives another scrambling and
/// must be well mixed. Whether a digit is flipped depends on all earlier digits only, so the points stay stratified.
/// The scrambling is a hash that propagates only toward higher bits (Laine and Karras 2011), as in Burley 2020,
/// "Practical Hash-based Owen Scrambling", §4, with Vegdahl's constants ("Building a Better LK Hash", 2021).
template <typename U> constexpr U owen_scramble(U reversed, U seed) {
    U x = reversed;
    x = x ^ (x * U(0x3d20adeau));
    x = x + seed;
    x = x * ((seed >> 16) | U(1u));
    x = x ^ (x * U(0x05526c56u));
    return x ^ (x * U(0x53a22864u));
}

} // namespace duet

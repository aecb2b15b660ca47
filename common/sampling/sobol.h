// The first two dimensions of Sobol's sequence, and Owen's scrambling of them.
//
// All functions here work on digits in *reversed* order: bit 0 is the first binary digit after the point (worth ½), bit
// 31 the last. So the index of a point is its own first coordinate (the van der Corput sequence), Owen scrambling lets
// each bit be flipped by lower bits only, which is what multiplication does, and bits are turned round once, at the
// end.
#pragma once

#include "common/vec/vec.h"

#include <cstdint>

namespace duet {

/// Bits in reverse order. As the functions below a template: U is std::uint32_t, or a SIMD batch of them.
template <typename U> constexpr U reverse_bits(U x) {
    x = (x >> 16) | (x << 16);
    x = ((x & U(0x00ff00ffu)) << 8) | ((x >> 8) & U(0x00ff00ffu));
    x = ((x & U(0x0f0f0f0fu)) << 4) | ((x >> 4) & U(0x0f0f0f0fu));
    x = ((x & U(0x33333333u)) << 2) | ((x >> 2) & U(0x33333333u));
    return ((x & U(0x55555555u)) << 1) | ((x >> 1) & U(0x55555555u));
}

/// The second coordinate of point `index`, digits reversed; the first is the index itself. The two are a (0,
/// 2)-sequence. The generator matrix from the primitive polynomial x + 1 (Joe and Kuo 2008, dimension 2) is Pascal's
/// triangle modulo 2. By Lucas's theorem binomial(j, i) is odd just where the bits of i are among the bits of j, so the
/// product of matrix and index is a sum over supersets, which five shifts compute. The tests hold it against the
/// direction numbers.
template <typename U> constexpr U sobol_second(U index) {
    U x = index;
    x = x ^ ((x >> 1) & U(0x55555555u));
    x = x ^ ((x >> 2) & U(0x33333333u));
    x = x ^ ((x >> 4) & U(0x0f0f0f0fu));
    x = x ^ ((x >> 8) & U(0x00ff00ffu));
    return x ^ ((x >> 16) & U(0x0000ffffu));
}

/// Point `index` of the first n, n a power of two up to 2^24: in each coordinate in the middle of its n-th. All n are a
/// (0, 2)-net, and so is each aligned part of 2^k.
inline Vec2 net_point(std::uint32_t index, int n) {
    const auto digits = [n](std::uint32_t reversed) {
        return static_cast<float>(reverse_bits(reversed)) * 0x1p-32f + 0.5f / static_cast<float>(n);
    };
    return {digits(index), digits(sobol_second(index))};
}

/// Nested uniform («Owen») scrambling of a number with reversed digits, one scrambling a seed: a digit is flipped or
/// not depending on all earlier digits, so points stay stratified. A hash that carries only upwards (Laine and Karras
/// 2011), as in Burley 2020, «Practical Hash-based Owen Scrambling», §4, with Vegdahl's constants («Building a Better
/// LK Hash», 2021). The seed must itself be well mixed.
template <typename U> constexpr U owen_scramble(U reversed, U seed) {
    U x = reversed;
    x = x ^ (x * U(0x3d20adeau));
    x = x + seed;
    x = x * ((seed >> 16) | U(1u));
    x = x ^ (x * U(0x05526c56u));
    return x ^ (x * U(0x53a22864u));
}

} // namespace duet

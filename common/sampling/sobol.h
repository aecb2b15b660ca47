// The first two dimensions of Sobol's sequence, and Owen's scrambling of them.
//
// All functions here work on digits in *reversed* order: bit 0 is the first binary digit after the point (worth ½), bit
// 31 the last. So the index of a point is its own first coordinate (the van der Corput sequence), Owen scrambling lets
// each bit be flipped by lower bits only, which is what multiplication does, and bits are turned round once, at the
// end.
#pragma once

#include <cstdint>

namespace duet {

/// Bits in reverse order.
constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// The second coordinate of point `index`, digits reversed; the first is the index itself. The two are a (0,
/// 2)-sequence. The generator matrix from the primitive polynomial x + 1 (Joe and Kuo 2008, dimension 2) is Pascal's
/// triangle modulo 2. By Lucas's theorem binomial(j, i) is odd just where the bits of i are among the bits of j, so the
/// product of matrix and index is a sum over supersets, which five shifts compute. The tests hold it against the
/// direction numbers.
constexpr std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t x = index;
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    x ^= (x >> 16) & 0x0000ffffu;
    return x;
}

/// Nested uniform («Owen») scrambling of a number with reversed digits, one scrambling a seed: a digit is flipped or
/// not depending on all earlier digits, so points stay stratified. A hash that carries only upwards (Laine and Karras
/// 2011), as in Burley 2020, «Practical Hash-based Owen Scrambling», §4, with Vegdahl's constants («Building a Better
/// LK Hash», 2021). The seed must itself be well mixed.
constexpr std::uint32_t owen_scramble(std::uint32_t reversed, std::uint32_t seed) {
    std::uint32_t x = reversed;
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

} // namespace duet

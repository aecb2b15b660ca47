#include "common/texture/noise.h"

#include "common/vec/scalar.h"
#include "common/vec/simd.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace duet {

namespace {

// The functions of this file are templates over D, double or DoubleBatch, and the integers W of as many bits.
using Words = xsimd::batch<std::uint64_t>;
static_assert(sizeof(Words) == sizeof(DoubleBatch));

std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }
double double_of(std::uint64_t bits) { return std::bit_cast<double>(bits); }
Words bits_of(DoubleBatch x) { return xsimd::bitwise_cast<Words>(x); }
DoubleBatch double_of(Words bits) { return xsimd::bitwise_cast<DoubleBatch>(bits); }

template <typename W> W low_half(W word) { return word & W(0xffffffff); }

// Returns the lattice coordinate modulo 2^32. It is exact in double, however large p is, and adding 2^52 moves it to
// the lowest bits of the mantissa. The result is unspecified for NaN.
template <typename W, typename D> W lattice_index(D floor_of_p) {
    using std::floor;
    constexpr double kPeriod = 0x1p32;
    const D index = floor_of_p - D(kPeriod) * floor(floor_of_p * D(1 / kPeriod));
    return low_half(bits_of(index + D(0x1p52)));
}

// Mixes a word into a hash in one round. For each word the round is a bijection of the hash. Multipliers and shifts
// are those of Stafford 2011, "Better Bit Mixing", variant 13, a 64-bit finalizer.
template <typename W> W mix(W hash, W word) {
    hash = (hash ^ word) * W(0xbf58476d1ce4e5b9);
    hash = hash ^ (hash >> 27);
    hash = hash * W(0x94d049bb133111eb);
    return hash ^ (hash >> 31);
}

// Returns the component of d along one of the twelve directions from a cube's center to the midpoints of its edges.
template <typename W, typename D> D along_gradient(W hash, Vec3T<D> d) {
    const W high = hash >> 32, edge = ((high << 3) + (high << 2)) >> 32; // 12 · high / 2^32
    const W x = bits_of(d.x), y = bits_of(d.y), z = bits_of(d.z);
    const W a = select(edge < W(8), x, y), b = select(edge < W(4), y, z);
    return double_of(a ^ (edge << 63)) + double_of(b ^ ((edge >> 1) << 63)); // negated where bit 0 and bit 1 are set
}

template <typename D> D fade(D t) { return t * t * t * (t * (t * D(6) - D(15)) + D(10)); }

template <typename W, typename D> D noise(Vec3T<D> p, W seed) {
    using std::floor;
    const Vec3T<D> corner{floor(p.x), floor(p.y), floor(p.z)};
    const Vec3T<D> d = p - corner; // in [0, 1]; 1 where a tiny negative p rounds to it
    const W x = lattice_index<W>(corner.x), y = lattice_index<W>(corner.y), z = lattice_index<W>(corner.z);
    std::array<D, 8> value;
    for (std::uint32_t i = 0; i < 2; ++i) {
        const W hash_x = mix(W(0x9e3779b97f4a7c15) + seed, low_half(x + W(i)));
        for (std::uint32_t j = 0; j < 2; ++j) {
            const W hash_xy = mix(hash_x, low_half(y + W(j)));
            for (std::uint32_t k = 0; k < 2; ++k)
                value[4 * i + 2 * j + k] =
                    along_gradient(mix(hash_xy, low_half(z + W(k))), d - Vec3T<D>(D(i), D(j), D(k)));
        }
    }
    const D u = fade(d.x), v = fade(d.y), w = fade(d.z);
    const auto along_z = [&](std::size_t i) { return lerp(value[i], value[i + 1], w); };
    // This is the largest value of the noise, found by maximizing the sum of each corner's weight times its largest
    // possible component.
    constexpr double kLargest = 1.0363538112118;
    return lerp(lerp(along_z(0), along_z(2), v), lerp(along_z(4), along_z(6), v), u) / D(kLargest);
}

} // namespace

double gradient_noise(Vec3d p, std::uint32_t seed) { return noise(p, std::uint64_t{seed}); }

// The lanes compute one octave each.
double fractal_noise(Vec3d p, int octaves) {
    // The components are fractional parts of powers of the golden ratio, so that the lattices of two octaves do not
    // coincide within any practical range.
    constexpr Vec3d kShift{0.618033988749895, 0.381966011250105, 0.236067977499790};
    constexpr int kLanes = static_cast<int>(kDoubleLanes);
    alignas(sizeof(DoubleBatch)) std::array<double, kDoubleLanes> frequencies, indices, values;
    alignas(sizeof(Words)) std::array<std::uint64_t, kDoubleLanes> seeds;
    double sum = 0, amplitude = 1, frequency = 1;
    for (int first = 0; first < octaves; first += kLanes) {
        for (int k = 0; k < kLanes; ++k, frequency *= 2) {
            const auto lane = static_cast<std::size_t>(k);
            frequencies[lane] = frequency, indices[lane] = first + k;
            seeds[lane] = static_cast<std::uint64_t>(first + k);
        }
        const auto at = [&](double x, double shift) {
            return DoubleBatch(x) * DoubleBatch::load_aligned(frequencies.data()) +
                   DoubleBatch(shift) * DoubleBatch::load_aligned(indices.data());
        };
        const Vec3T<DoubleBatch> points{at(p.x, kShift.x), at(p.y, kShift.y), at(p.z, kShift.z)};
        noise(points, Words::load_aligned(seeds.data())).store_aligned(values.data());
        for (int k = 0; k < std::min(kLanes, octaves - first); ++k, amplitude /= 2)
            sum += amplitude * values[static_cast<std::size_t>(k)];
    }
    return sum;
}

} // namespace duet

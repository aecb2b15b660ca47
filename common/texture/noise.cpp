#include "common/texture/noise.h"

#include <array>
#include <cmath>

namespace duet {

namespace {

// Returns the lattice coordinate modulo 2^32. It is exact in double, and no conversion overflows, however large p is.
// The result is 0 for NaN.
std::uint32_t lattice_index(double floor_of_p) {
    constexpr double kPeriod = 0x1p32;
    const double index = floor_of_p - kPeriod * std::floor(floor_of_p / kPeriod);
    return index >= 0 && index < kPeriod ? static_cast<std::uint32_t>(index) : 0u;
}

// Mixes a word into a hash in one round. For each word the round is a bijection of the hash. Multipliers and shifts
// are those of Stafford 2011, "Better Bit Mixing", variant 13, a 64-bit finalizer.
std::uint64_t mix(std::uint64_t hash, std::uint32_t word) {
    hash = (hash ^ word) * 0xbf58476d1ce4e5b9ull;
    hash ^= hash >> 27;
    hash *= 0x94d049bb133111ebull;
    return hash ^ hash >> 31;
}

// Returns the component of d along one of the twelve directions from a cube's center to the midpoints of its edges.
double along_gradient(std::uint64_t hash, Vec3d d) {
    const auto edge = static_cast<unsigned>((hash >> 32) * 12 >> 32);
    const double a = edge < 8 ? d.x : d.y, b = edge < 4 ? d.y : d.z;
    return ((edge & 1) == 0 ? a : -a) + ((edge & 2) == 0 ? b : -b);
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

} // namespace

double gradient_noise(Vec3d p, std::uint32_t seed) {
    const Vec3d corner{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const Vec3d d = p - corner; // in [0, 1]; 1 where a tiny negative p rounds to it
    const std::uint32_t x = lattice_index(corner.x), y = lattice_index(corner.y), z = lattice_index(corner.z);
    std::array<double, 8> value{};
    for (std::uint32_t i = 0; i < 2; ++i) {
        const std::uint64_t hash_x = mix(0x9e3779b97f4a7c15ull + seed, x + i);
        for (std::uint32_t j = 0; j < 2; ++j) {
            const std::uint64_t hash_xy = mix(hash_x, y + j);
            for (std::uint32_t k = 0; k < 2; ++k)
                value[4 * i + 2 * j + k] = along_gradient(mix(hash_xy, z + k), d - Vec3d(i, j, k));
        }
    }
    const double u = fade(d.x), v = fade(d.y), w = fade(d.z);
    const auto along_z = [&](std::size_t i) { return lerp(value[i], value[i + 1], w); };
    // This is the largest value of the noise, found by maximizing the sum of each corner's weight times its largest
    // possible component.
    constexpr double kLargest = 1.0363538112118;
    return lerp(lerp(along_z(0), along_z(2), v), lerp(along_z(4), along_z(6), v), u) / kLargest;
}

double fractal_noise(Vec3d p, int octaves) {
    // The components are fractional parts of powers of the golden ratio, so that the lattices of two octaves do not
    // coincide within any practical range.
    constexpr Vec3d kShift{0.618033988749895, 0.381966011250105, 0.236067977499790};
    double sum = 0, amplitude = 1, frequency = 1;
    for (int i = 0; i < octaves; ++i) {
        sum +=
            amplitude * gradient_noise(p * frequency + kShift * static_cast<double>(i), static_cast<std::uint32_t>(i));
        amplitude /= 2;
        frequency *= 2;
    }
    return sum;
}

} // namespace duet

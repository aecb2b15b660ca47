#include "common/texture/noise.h"

#include "common/sampling/hash.h"

#include <cmath>
#include <cstdint>

namespace duet {

namespace {

// A lattice coordinate modulo 2^32, and the position in the cell.
struct Cell {
    std::uint32_t index;
    double fraction;
};
Cell cell(double x) {
    constexpr double kPeriod = 4294967296.0;
    const double wrapped = x - kPeriod * std::floor(x / kPeriod); // in [0, 2^32]; the upper end by rounding only
    const double low = std::floor(wrapped);
    return {static_cast<std::uint32_t>(static_cast<std::uint64_t>(low)), wrapped - low};
}

// The dot product with one of the twelve gradients to the middles of a cube's edges, four of them twice.
double gradient_dot(std::uint32_t x, std::uint32_t y, std::uint32_t z, Vec3d d) {
    const std::uint64_t key = hash_combine((static_cast<std::uint64_t>(x) << 32) | y, z);
    const auto h = static_cast<unsigned>(mix_bits(key) >> 60);
    const double u = h < 8 ? d.x : d.y;
    const double v = h < 4 ? d.y : h == 12 || h == 14 ? d.x : d.z;
    return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

// 6t⁵ − 15t⁴ + 10t³: first and second derivative vanish at both ends.
double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

} // namespace

double gradient_noise(Vec3d p) {
    const Cell x = cell(p.x), y = cell(p.y), z = cell(p.z);
    const auto corner = [&](unsigned i, unsigned j, unsigned k) {
        return gradient_dot(x.index + i, y.index + j, z.index + k, {x.fraction - i, y.fraction - j, z.fraction - k});
    };
    const double u = fade(x.fraction), v = fade(y.fraction), w = fade(z.fraction);
    const auto along_x = [&](unsigned j, unsigned k) { return lerp(corner(0, j, k), corner(1, j, k), u); };
    const auto plane = [&](unsigned k) { return lerp(along_x(0, k), along_x(1, k), v); };
    return lerp(plane(0), plane(1), w);
}

double fractal_noise(Vec3d p, int octaves) {
    double sum = 0, amplitude = 1;
    for (int i = 0; i < octaves; ++i, amplitude /= 2, p = p * 2.0) sum += amplitude * gradient_noise(p);
    return sum;
}

double turbulence(Vec3d p, int octaves) {
    double sum = 0, amplitude = 1;
    for (int i = 0; i < octaves; ++i, amplitude /= 2, p = p * 2.0) sum += amplitude * std::abs(gradient_noise(p));
    return sum;
}

} // namespace duet

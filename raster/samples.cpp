#include "raster/samples.h"

#include <cmath>

namespace duet::raster {
namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/// Owen's nested uniform scramble of a binary fraction by a hash in which each bit depends on the higher ones only
/// (Laine and Karras 2011, §3.1; constants: Burley 2020, §3.3's hash as improved by Vegdahl 2021).
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

/// A well-mixed number of two (finalizer of MurmurHash3).
std::uint32_t mix(std::uint64_t seed, std::uint32_t stream) {
    std::uint64_t h = seed ^ (0x9e3779b97f4a7c15u * (stream + 1u));
    h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdu;
    h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53u;
    return static_cast<std::uint32_t>(h ^ (h >> 33));
}

/// Sobol's second dimension of point i (Sobol 1967); the first is van der Corput's, reverse_bits(i).
std::uint32_t sobol_second(std::uint32_t i) {
    std::uint32_t result = 0;
    for (std::uint32_t v = 1u << 31; i != 0; i >>= 1, v ^= v >> 1)
        if (i & 1u) result ^= v;
    return result;
}

/// Point i of the (0,2)-sequence that `stream` names, as 32-bit fractions.
struct Point {
    std::uint32_t x, y;
};
Point point(std::uint32_t i, std::uint64_t seed, std::uint32_t stream) {
    const std::uint32_t shuffled = reverse_bits(owen_scramble(reverse_bits(i), mix(seed, 4 * stream)));
    return {owen_scramble(reverse_bits(shuffled), mix(seed, 4 * stream + 1)),
            owen_scramble(sobol_second(shuffled), mix(seed, 4 * stream + 2))};
}

double fraction(std::uint32_t x) { return x * 0x1p-32; }
/// To the nearest grid point, which keeps the mean of a uniform number: 0 and 256 are each half as likely as the rest.
std::int32_t on_grid(std::uint32_t x) { return static_cast<std::int32_t>(std::lrint(fraction(x) * kSubPixels)); }

} // namespace

std::vector<Pass> plan_passes(int count, std::uint64_t seed, bool lens, bool motion) {
    if (count <= 1) return {Pass{.samples = {SampleOffset{}}}};
    std::vector<Pass> passes(1);
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        if ((lens || motion) && i > 0) passes.emplace_back();
        const Point in_pixel = point(index, seed, 0);
        passes.back().samples.push_back({on_grid(in_pixel.x), on_grid(in_pixel.y)});
        if (lens) {
            const Point on_lens = point(index, seed, 1);
            passes.back().lens = {fraction(on_lens.x), fraction(on_lens.y)};
        }
        if (motion) passes.back().time = fraction(point(index, seed, 2).x);
    }
    return passes;
}

} // namespace duet::raster

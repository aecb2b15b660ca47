#include "raster/geometry/sample_positions.h"

#include "common/sampling/hash.h"
#include "common/sampling/sobol.h"

#include <cmath>

namespace duet::raster {
namespace {

/// Represents point i of the (0,2)-sequence identified by `stream`, as 32-bit fractions. The functions of
/// common/sampling/sobol.h work on reversed bits. Scrambling the index permutes the aligned blocks of 2^k points.
struct Point {
    std::uint32_t x, y;
};
Point point(std::uint32_t i, std::uint64_t seed, std::uint64_t stream) {
    const auto key = [&](std::uint64_t purpose) {
        return high_bits(hash_combine(hash_combine(seed, stream), purpose));
    };
    const std::uint32_t shuffled = reverse_bits(owen_scramble(reverse_bits(i), key(0)));
    return {reverse_bits(owen_scramble(shuffled, key(1))), reverse_bits(owen_scramble(sobol_second(shuffled), key(2)))};
}

double fraction(std::uint32_t x) { return x * 0x1p-32; }
/// Rounds to the nearest grid point. The mean of a uniform variable is preserved: 0 and 256 are each half as likely
/// as the other values.
std::int32_t on_grid(std::uint32_t x) { return static_cast<std::int32_t>(std::lrint(fraction(x) * kSubpixels)); }

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

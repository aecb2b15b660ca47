// This header defines random numbers for tests.
#pragma once

#include "common/sampling/hash.h"
#include "common/sampling/warp.h"
#include "common/vec/vec.h"

#include <cmath>
#include <cstdint>

namespace duet::test {

/// Draws random numbers that depend only on the seed: by default in [0, 1).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(mix_bits(seed + kGoldenGamma)) {}
    float operator()() { return unit_float(high_bits(stream_number(state_, count_++))); }
    Vec2 pair() { return {(*this)(), (*this)()}; }
    float range(float low, float high) { return lerp(low, high, (*this)()); }
    /// Returns a number whose logarithm is uniform.
    float log_range(float low, float high) { return low * std::pow(high / low, (*this)()); }
    Vec3 direction() { return uniform_sphere(pair()); }

private:
    std::uint64_t state_, count_ = 0;
};

} // namespace duet::test

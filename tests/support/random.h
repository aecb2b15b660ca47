// This header defines random numbers for tests.
#pragma once

#include "common/sampling/hash.h"
#include "common/vec/vec.h"

#include <cstdint>

namespace duet::test {

/// Draws random numbers in [0, 1) that depend only on the seed.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(mix_bits(seed + kGoldenGamma)) {}
    float operator()() { return unit_float(high_bits(stream_number(state_, count_++))); }
    Vec2 pair() { return {(*this)(), (*this)()}; }

private:
    std::uint64_t state_, count_ = 0;
};

} // namespace duet::test

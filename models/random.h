// This header declares a small random number generator with the same output on every platform.
#pragma once

#include <cstdint>

namespace duet::models {

/// Implements PCG32, XSH-RR (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
/// Algorithms", §6.3). Unlike the distributions of `<random>`, its output for a seed is determined by integer
/// arithmetic alone.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * kMultiplier + kIncrement) { next(); }

    /// Returns a uniform value in [0, 1).
    double uniform() { return next() * 0x1p-32; }
    /// Returns a uniform value in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

private:
    static constexpr std::uint64_t kMultiplier = 6364136223846793005u, kIncrement = 1442695040888963407u;

    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * kMultiplier + kIncrement;
        const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
        const auto turn = static_cast<std::uint32_t>(old >> 59);
        return (shifted >> turn) | (shifted << ((32 - turn) & 31));
    }
    std::uint64_t state_;
};

} // namespace duet::models

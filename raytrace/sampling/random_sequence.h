// Provides random numbers for a count that is not known in advance: for media and solids along a ray, and for the steps
// of a Markov chain.
#pragma once

#include "common/image/rgb.h"
#include "common/sampling/hash.h"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace duet::raytrace {

/// Draws random numbers in [0, 1) that are determined by one number.
class RandomSequence {
public:
    explicit RandomSequence(float u) : RandomSequence(std::uint64_t{std::bit_cast<std::uint32_t>(u)}) {}
    /// Draws numbers that are determined by a seed.
    explicit RandomSequence(std::uint64_t seed) : stream_(mix_bits(seed + kGoldenGamma)) {}
    /// Returns the next number.
    float operator()() { return unit_float(high_bits(stream_number(stream_, drawn_++))); }

private:
    std::uint64_t stream_, drawn_ = 0;
};

/// Represents a color channel that is chosen with a probability in proportion to its weight. If distances are drawn for
/// a channel chosen by the throughput, the weights of all channels stay bounded (Wilkie et al. 2014, "Hero Wavelength
/// Spectral Sampling").
struct ChosenChannel {
    Rgb probabilities; ///< probabilities of all channels
    std::size_t index;

    /// Chooses a channel by u in [0, 1). At least one weight must be positive, and none negative.
    ChosenChannel(Rgb weights, float u) : probabilities(weights / (weights.r + weights.g + weights.b)) {
        const Rgb& p = probabilities;
        index = u < p.r ? 0 : u < p.r + p.g || p.b == 0 ? 1 : 2;
    }
    /// Returns the mean of the values, weighted by the channels' probabilities.
    float mean(Rgb values) const {
        const Rgb products = probabilities * values;
        return products.r + products.g + products.b;
    }
};

} // namespace duet::raytrace

// Random numbers where their count is not known before: what media and solids do to a path between two vertices, and
// the steps of a Markov chain.
#pragma once

#include "common/image/rgb.h"
#include "common/sampling/hash.h"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace duet::raytrace {

/// Draws random numbers in [0, 1) that follow from one.
class RandomSequence {
public:
    explicit RandomSequence(float u) : RandomSequence(std::uint64_t{std::bit_cast<std::uint32_t>(u)}) {}
    /// Draws numbers that follow from a seed.
    explicit RandomSequence(std::uint64_t seed) : stream_(mix_bits(seed + kGoldenGamma)) {}
    /// Returns the next number.
    float operator()() { return unit_float(high_bits(stream_number(stream_, drawn_++))); }

private:
    std::uint64_t stream_, drawn_ = 0;
};

/// A color channel that was chosen with a probability in proportion to its weight. A path whose distances are drawn for
/// a channel chosen by the throughput has bounded weights in all (Wilkie et al. 2014, "Hero Wavelength Spectral
/// Sampling").
struct ChosenChannel {
    Rgb probabilities; ///< of all channels
    std::size_t index;

    /// Chooses by u in [0, 1). At least one weight must be positive, and none negative.
    ChosenChannel(Rgb weights, float u) : probabilities(weights / (weights.r + weights.g + weights.b)) {
        const Rgb& p = probabilities;
        index = u < p.r ? 0 : u < p.r + p.g || p.b == 0 ? 1 : 2;
    }
    /// Returns the mean over the choice.
    float mean(Rgb values) const {
        const Rgb products = probabilities * values;
        return products.r + products.g + products.b;
    }
};

} // namespace duet::raytrace

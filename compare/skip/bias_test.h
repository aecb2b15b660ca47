// Whether two ways of rendering have the same expected picture, to a thousandth.
#pragma once

#include "common/image/rgb.h"

#include <vector>

namespace duet::compare {

/// The odds of calling two ways different which are not, and of missing a bias that is called detectable.
inline constexpr double kFalseAlarm = 0.01, kMiss = 0.01;
/// Of fewer pairs the spread of the differences is not known well enough.
inline constexpr int kFewestPairs = 64;

/// A paired test: each pair are the mean colours of two pictures rendered the two ways from the same seed, whose random
/// numbers are the same where both ways use them. So what both have is no noise, and few pairs see a small bias.
class BiasTest {
public:
    /// Mean colours of the pictures with and without the skip.
    void add(Rgbd with, Rgbd without);

    int pairs() const { return static_cast<int>(differences_.size()); }
    /// Mean of with − without, relative to without, by channel; 0 of a black channel.
    Rgbd bias() const;
    /// The relative bias of a channel that is found with probability 1 − kMiss; infinite for fewer than kFewestPairs.
    /// The largest of all channels.
    double detectable() const;
    /// The odds that ways of the same expected mean differ at least so much, corrected for the three channels. Below
    /// kFalseAlarm: they are not the same.
    double p() const;
    /// About how many pairs it takes for detectable() to be `bias`, by the noise seen so far.
    double pairs_needed(double bias) const;

private:
    /// Of a channel's differences.
    struct Moments {
        double mean, deviation, skewness;
    };
    Moments moments(std::size_t channel) const;

    std::vector<Rgbd> differences_;
    Rgbd without_; ///< sum
};

} // namespace duet::compare

// This file tests whether two methods of rendering have the same expected image, up to a thousandth.
#pragma once

#include "common/image/rgb.h"

#include <vector>

namespace duet::compare {

/// These are the probabilities of a false alarm, and of missing a bias of the size that is reported as detectable.
inline constexpr double kFalseAlarmProbability = 0.01, kMissProbability = 0.01;
/// With fewer pairs, the variance of the differences is not known well enough.
inline constexpr int kMinPairs = 64;

/// A BiasTest is a paired test. A pair consists of the mean colors of two images rendered by the two methods from the
/// same seed. Both methods draw the same random numbers wherever they use them alike. Common noise therefore cancels,
/// and few pairs detect a small bias.
class BiasTest {
public:
    /// Adds the mean colors of the images with and without the skip.
    void add(Rgbd with, Rgbd without);

    int pairs() const { return static_cast<int>(differences_.size()); }
    /// Returns the mean of with − without, relative to without, per channel; 0 for a black channel.
    Rgbd bias() const;
    /// Returns the relative bias that is found with probability 1 − kMissProbability, maximum over the channels. The
    /// result is infinite for fewer than kMinPairs pairs.
    double detectable() const;
    /// Returns the probability that two methods with the same expected mean differ at least this much, corrected for
    /// the three channels. Below kFalseAlarmProbability, they count as different.
    double p() const;
    /// Returns about how many pairs are needed for detectable() to be `bias`, given the noise so far.
    double pairs_needed(double bias) const;

private:
    /// Holds the moments of a channel's differences.
    struct Moments {
        double mean, deviation, skewness;
    };
    Moments moments(std::size_t channel) const;

    std::vector<Rgbd> differences_;
    Rgbd without_; ///< sum over the pairs
};

} // namespace duet::compare

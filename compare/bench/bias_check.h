// Do two independent estimators agree about a scene? A bias of our own shows where they do not.
#pragma once

#include "compare/bench/reference.h"

#include <cstdint>

namespace duet::compare {

/// The most significant of all differences of block means, and what follows from it.
struct BiasCheck {
    std::size_t tests = 0; ///< means compared: three channels of each block, and of the whole picture
    double worst_z = 0;    ///< their difference in standard errors, signed (first − second) …
    double worst_dof = 0;  ///< … the degrees of freedom of that error …
    double p_value = 1;    ///< … and the odds of any such difference by chance, for all tests together
    int block_x = 0, block_y = 0, block_size = 0, channel = 0; ///< where; block_size 0: the whole picture
    Rgbd relative_bias;    ///< difference of the whole pictures' means over the second's mean, by channel
    double detectable = 0; ///< the smallest such relative bias that would be found with 99 % power

    /// False alarms happen once in a thousand runs.
    static constexpr double kSignificance = 1e-3;
    bool consistent() const { return p_value >= kSignificance; }
};

/// Compares the means of blocks of about 8 × 8 to a picture and of the whole by Welch's t-test. Each mean's variance is
/// the sum of its pixels' (pixels are independent); its degrees of freedom follow from them by Welch and Satterthwaite,
/// each pixel counting for one: where a few fireflies make up the variance there are few, and the test is duly careful.
/// Pictures of one size; throws Error otherwise.
/// (z_test of compare/metrics/z_test.h takes blocks of 1024 pixels, whose sums are nearly normal; smaller ones, which show
/// one wrong lamp in a picture of 64 × 64, are paid for here in degrees of freedom.)
BiasCheck check_bias(const Reference& a, const Reference& b);

} // namespace duet::compare

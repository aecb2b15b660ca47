// This file tests whether two independent estimators agree on a scene. A disagreement reveals a bias of one of them.
#pragma once

#include "compare/bench/reference.h"

#include <cstdint>

namespace duet::compare {

/// Holds the most significant difference of block means, and the conclusion from it.
struct BiasCheck {
    std::size_t tests = 0; ///< number of means compared: three channels of each block and of the whole image
    double worst_z = 0;    ///< most significant difference in standard errors, signed (first − second)
    double worst_dof = 0;  ///< degrees of freedom of the standard error in worst_z
    double p_value = 1;    ///< probability of any such difference by chance, over all tests
    int block_x = 0, block_y = 0, block_size = 0, channel = 0; ///< location; block_size 0: the whole image
    Rgbd relative_bias;    ///< difference of the whole images' means over the second mean, per channel
    double detectable = 0; ///< smallest relative bias of the whole image that is found with 99 % power

    /// This significance level means one false alarm in a thousand runs.
    static constexpr double kSignificance = 1e-3;
    bool consistent() const { return p_value >= kSignificance; }
};

/// Compares the means of about 8 × 8 blocks and of the whole image by Welch's t-test. The variance of a mean is
/// computed from the sum of its pixels' variances, because pixels are independent. Its degrees of freedom follow by
/// Welch and Satterthwaite, with one degree per pixel. If a few fireflies dominate the variance, there are few degrees
/// of freedom, and the test is accordingly cautious. Throws Error if the images differ in size. (z_test of
/// compare/metrics/z_test.h uses blocks of 1024 pixels, whose sums are nearly normal. The smaller blocks here can
/// reveal one wrong light in an image of 64 × 64 pixels, at the cost of degrees of freedom.)
BiasCheck check_bias(const Reference& a, const Reference& b);

} // namespace duet::compare

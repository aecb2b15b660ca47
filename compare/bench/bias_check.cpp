#include "compare/bench/bias_check.h"

#include "compare/bench/estimate.h"
#include "compare/metrics/same_size.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

/// Holds the mean of one channel over a rectangle, with its variance.
struct BlockMean {
    double mean = 0, variance = 0;
    double squares = 0; ///< sum of squared pixel contributions to `variance`; variance² / squares are the degrees of
                        ///< freedom
};

BlockMean block_mean(const Reference& r, int x0, int y0, int x1, int y1, std::size_t channel) {
    BlockMean block;
    const double pixels = static_cast<double>(x1 - x0) * (y1 - y0);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const double variance = static_cast<double>(r.variance(x, y)[channel]) / sqr(pixels);
            block.mean += static_cast<double>(r.mean(x, y)[channel]) / pixels;
            block.variance += variance;
            block.squares += sqr(variance);
        }
    return block;
}

struct Difference {
    double z = 0, dof = 1, p_value = 1, error = 0;
};

Difference difference(const BlockMean& a, const BlockMean& b) {
    const double variance = a.variance + b.variance, delta = a.mean - b.mean;
    // The rounding error of sums of floats makes even equal means differ. It is the whole error if no pixel varies.
    const double rounding = 1e-6 * std::max(std::abs(a.mean), std::abs(b.mean));
    Difference d;
    d.error = std::sqrt(variance + sqr(rounding));
    if (d.error == 0) return d; // black in both images
    const double squares = a.squares + b.squares;
    d.z = delta / d.error;
    d.dof = squares > 0 ? std::max(1.0, sqr(variance) / squares) : 1e6;
    d.p_value = student_t_tail(d.z, d.dof);
    return d;
}

} // namespace

BiasCheck check_bias(const Reference& a, const Reference& b) {
    check_same_size(a.mean, b.mean);
    const int width = a.mean.width(), height = a.mean.height();
    BiasCheck check;
    double smallest = 2;
    const auto compare_block = [&](int x0, int y0, int x1, int y1, int size) {
        for (std::size_t c = 0; c < 3; ++c) {
            const BlockMean mean_b = block_mean(b, x0, y0, x1, y1, c);
            const Difference d = difference(block_mean(a, x0, y0, x1, y1, c), mean_b);
            ++check.tests;
            if (size == 0 && mean_b.mean > 0) check.relative_bias[c] = d.z * d.error / mean_b.mean;
            if (d.p_value >= smallest) continue;
            smallest = d.p_value;
            check.worst_z = d.z;
            check.worst_dof = d.dof;
            check.block_x = x0;
            check.block_y = y0;
            check.block_size = size;
            check.channel = static_cast<int>(c);
        }
    };
    const int size = std::max(1, (std::max(width, height) + 7) / 8);
    for (int y = 0; y < height; y += size)
        for (int x = 0; x < width; x += size)
            compare_block(x, y, std::min(x + size, width), std::min(y + size, height), size);
    compare_block(0, 0, width, height, 0);
    check.p_value = std::min(1.0, smallest * static_cast<double>(check.tests));

    // A bias found with 99 % power exceeds the threshold even if noise reduces it by 2.33 standard errors.
    double worst_channel = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const BlockMean mean_b = block_mean(b, 0, 0, width, height, c);
        const Difference d = difference(block_mean(a, 0, 0, width, height, c), mean_b);
        const double needed =
            student_t_critical(shared_significance(BiasCheck::kSignificance, check.tests), d.dof) + 2.33;
        if (mean_b.mean > 0) worst_channel = std::max(worst_channel, needed * d.error / mean_b.mean);
    }
    check.detectable = worst_channel;
    return check;
}

} // namespace duet::compare

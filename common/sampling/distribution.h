// Piecewise constant distributions over [0, 1) and [0, 1)².
#pragma once

#include "common/vec/vec.h"

#include <vector>

namespace duet {

/// Sampled in proportion to n non-negative values, each on an interval of 1/n.
class Distribution1D {
public:
    Distribution1D() = default;
    /// values: finite, ≥ 0. If all are 0 the distribution is uniform and integral() is 0.
    explicit Distribution1D(const std::vector<double>& values);

    struct Sample {
        float x;           ///< in [0, 1)
        float pdf;         ///< density at x
        std::size_t index; ///< of the interval
        float remapped;    ///< position within it: a fresh number in [0, 1)
    };
    Sample sample(float u) const;
    /// The density at x in [0, 1).
    float pdf(float x) const;
    /// The probability of interval i.
    float probability(std::size_t i) const;
    /// Mean of the values: ∫ f over [0, 1].
    double integral() const { return integral_; }
    std::size_t size() const { return cdf_.empty() ? 0 : cdf_.size() - 1; }

private:
    std::vector<double> cdf_; ///< n + 1 values from 0 to 1, non-decreasing
    double integral_ = 0;
};

/// Rows (v) of piecewise constant densities over u.
class Distribution2D {
public:
    Distribution2D() = default;
    /// width × height values, row 0 at v in [0, 1/height).
    Distribution2D(const std::vector<double>& values, int width, int height);

    struct Sample {
        Vec2 uv;
        float pdf;
    };
    Sample sample(Vec2 u) const;
    float pdf(Vec2 uv) const;
    double integral() const { return marginal_.integral(); }

private:
    std::vector<Distribution1D> rows_;
    Distribution1D marginal_;
};

} // namespace duet

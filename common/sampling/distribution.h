// This file defines piecewise constant distributions over [0, 1) and [0, 1)².
#pragma once

#include "common/vec/vec.h"

#include <vector>

namespace duet {

/// The density of this distribution is proportional to n non-negative values. Value i applies to the interval
/// [i/n, (i+1)/n).
class Distribution1D {
public:
    Distribution1D() = default;
    /// There must be at least one value, and all must be finite and >= 0; otherwise the program aborts. If all values
    /// are 0, the distribution is uniform and integral() is 0.
    explicit Distribution1D(const std::vector<double>& values);

    struct Sample {
        float x;           ///< in [0, 1)
        float pdf;         ///< density at x
        std::size_t index; ///< index of the interval
        float remapped;    ///< relative position inside the interval; a new uniform sample in [0, 1)
    };
    /// Maps a uniform sample u in [0, 1) to a sample of the distribution. Values outside are clamped.
    Sample sample(float u) const;
    /// Returns the density at x, which is 0 outside [0, 1).
    float pdf(float x) const;
    /// Returns the probability of interval i, for i < size().
    float probability(std::size_t i) const;
    /// Returns the mean of the values, which is the integral of the piecewise constant function over [0, 1].
    double integral() const { return integral_; }
    std::size_t size() const { return cdf_.empty() ? 0 : cdf_.size() - 1; }

private:
    std::vector<double> cdf_; ///< n + 1 nondecreasing values from 0 to 1
    double integral_ = 0;
};

/// The density of this distribution over (u, v) in [0, 1)² is piecewise constant on a grid. v selects a row, and u a
/// column.
class Distribution2D {
public:
    Distribution2D() = default;
    /// Takes width × height finite values >= 0, row by row. Row 0 covers v in [0, 1/height). Other input aborts the
    /// program.
    Distribution2D(const std::vector<double>& values, int width, int height);

    struct Sample {
        Vec2 uv;
        float pdf;
    };
    /// Maps a uniform sample u in [0, 1)² to a sample of the distribution.
    Sample sample(Vec2 u) const;
    /// Returns the density at uv, which is 0 outside [0, 1)².
    float pdf(Vec2 uv) const;
    /// Returns the mean of the values.
    double integral() const { return marginal_.integral(); }

private:
    std::vector<Distribution1D> rows_;
    Distribution1D marginal_;
};

} // namespace duet

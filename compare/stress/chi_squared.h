// This header declares Pearson's chi-squared test, which compares counts with expected frequencies.
#pragma once

#include "common/vec/vec.h"
#include "compare/metrics/normal_distribution.h" // sidak_level, for several tests

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// Returns P(X > statistic) for a chi-squared distributed X: the regularized upper incomplete gamma function Q(dof/2,
/// statistic/2).
double chi_squared_tail(double statistic, int degrees_of_freedom);

/// Holds the result of a chi-squared test.
struct ChiSquared {
    double p_value = 0; ///< probability of counts at least this unlikely
    std::string details; ///< statistic, degrees of freedom and worst bin, for the failure message
};
/// Compares two histograms of equal size. Bins with an expectation below 5 are pooled, including those with
/// expectation 0.
ChiSquared chi_squared(const std::vector<double>& observed, const std::vector<double>& expected);

/// Draws directions and compares them with a density by solid angle, over cells in a frame about `axis`, where the
/// density's features lie. For axis_power = 1 the cells have equal solid angles. Draws without a sample are counted
/// in a separate bin. If there are none, the density is normalized by its integral, so the caller should check the
/// integral, too.
struct DirectionTest {
    Vec3 axis{0, 0, 1};
    int samples = 100'000;
    std::uint64_t seed = 1;
    int rings = 16, sectors = 32;
    int subdivisions = 8; ///< per cell and axis, for the quadrature of the density
    double axis_power = 1; ///< ring borders are at 1 − cos θ = 2·(i/rings)^power; larger values narrow the rings
};
/// Holds the result of a DirectionTest.
struct DirectionResult {
    ChiSquared chi_squared;
    double integral = 0; ///< of the density over the sphere
};
using DirectionSampler = std::function<std::optional<Vec3>(Vec2)>;
using DirectionDensity = std::function<double(Vec3)>;
/// Runs the test. `sample` gets points of [0, 1)², and `pdf` returns the density by solid angle.
DirectionResult test_directions(const DirectionTest& test, const DirectionSampler& sample, const DirectionDensity& pdf);

} // namespace duet::compare

// Pearson's chi-squared test: do counts follow the expected frequencies?
#pragma once

#include "common/vec/vec.h"
#include "compare/metrics/normal.h" // sidak_level, for several tests

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace duet::compare {

/// P(X > statistic) for X chi-squared distributed: the regularized upper incomplete gamma function Q(dof/2,
/// statistic/2).
double chi_squared_tail(double statistic, int degrees_of_freedom);

struct ChiSquared {
    double p_value = 0;  ///< the odds of counts at least this unlikely
    std::string account; ///< statistic, degrees of freedom, worst bin: for the message of a failure
};
/// Bins of expectation below 5 are pooled, with those where nothing is expected.
ChiSquared chi_squared(const std::vector<double>& observed, const std::vector<double>& expected);

/// Draws directions and compares them with a density by solid angle over cells of equal solid angle in a frame about
/// `axis`, where the density's features lie. Draws that give nothing are counted in a bin of their own; if none did,
/// the density is taken as it is up to a factor: check the integral, too.
struct DirectionTest {
    Vec3 axis{0, 0, 1};
    int samples = 100'000;
    std::uint64_t seed = 1;
    int rings = 16, sectors = 32;
    int subdivisions = 8; ///< of a cell along each axis for the quadrature of the density
    double axis_power =
        1; ///< cells are narrower about the axis the larger it is: ring borders at 1 − cos θ = 2·(i/rings)^power
};
struct DirectionResult {
    ChiSquared chi_squared;
    double integral = 0; ///< of the density over the sphere
};
using DirectionSampler = std::function<std::optional<Vec3>(Vec2)>;
using DirectionDensity = std::function<double(Vec3)>;
DirectionResult test_directions(const DirectionTest& test, const DirectionSampler& sample, const DirectionDensity& pdf);

} // namespace duet::compare

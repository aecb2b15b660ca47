// This file declares functions of the normal distribution that statistical tests need.
#pragma once

namespace duet::compare {

/// Returns the probability that a standard normal variable is further from 0 than |z|. The result is exact up to
/// rounding, down to 1e-300.
double two_sided_p(double z);
/// Returns the z ≥ 0 that a standard normal variable exceeds with probability p in (0, 0.5].
double upper_quantile(double p);
/// Returns the probability that the smallest of `tests` independent, uniform p-values is at most p (Šidák 1967).
double sidak(double p, double tests);
/// Returns the p-value of a single test for which sidak() of `tests` tests is `level`.
double sidak_level(double level, double tests);

} // namespace duet::compare

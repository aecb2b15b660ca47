// The normal distribution, as tests need it.
#pragma once

namespace duet::compare {

/// The probability that a standard normal variable is further from 0 than |z|. Exact to rounding down to 1e-300.
double two_sided_p(double z);
/// The z ≥ 0 beyond which a standard normal variable is, to one side, with probability p in (0, 0.5].
double upper_quantile(double p);
/// The probability that the smallest of `tests` independent p-values is at most p, each uniform (Šidák 1967).
double sidak(double p, double tests);
/// The p-value that each of `tests` tests may have for sidak() to be `level`.
double sidak_level(double level, double tests);

} // namespace duet::compare

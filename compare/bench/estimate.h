// This file defines estimates with their uncertainty, from a few repeated measurements.
#pragma once

#include <vector>

namespace duet::compare {

/// Returns P(|T| ≥ |t|) for Student's t distribution with `dof` > 0 degrees of freedom, which may be fractional.
double student_t_tail(double t, double dof);
/// Returns the t with P(|T| ≥ t) = alpha, for 0 < alpha < 1.
double student_t_critical(double alpha, double dof);
/// Returns the significance level of each of `tests` tests for which the probability of any false alarm is at
/// most `alpha`: alpha / tests (Bonferroni). This also holds for dependent tests.
inline double shared_significance(double alpha, std::size_t tests) {
    return alpha / static_cast<double>(tests > 0 ? tests : 1);
}

/// An Estimate is a positive quantity with a confidence band. The uncertainty is relative, and the band is symmetric on
/// a logarithmic scale: value · exp(± t · relative_error), with Student's t. To first order in the relative error this
/// is the usual band (the delta method). It never contains zero, and products and quotients propagate by adding
/// squares.
struct Estimate {
    double value = 0;          ///< NaN if nothing was measured
    double relative_error = 0; ///< standard error / value; infinity: a single measurement
    double dof = 1;            ///< degrees of freedom of relative_error

    /// Returns the lower end of the confidence band; 0 if the error is unknown.
    double low(double confidence = 0.95) const;
    /// Returns the upper end of the confidence band; infinity if the error is unknown.
    double high(double confidence = 0.95) const;
};

/// Returns the arithmetic mean of independent measurements.
Estimate mean_of(const std::vector<double>& values);
/// Returns the median, which outliers hardly disturb. Its standard error is √(π/2) times that of the mean of
/// logarithms, as for a normal distribution and many values. For an even number of values, the median is the mean of
/// the middle two.
Estimate median_of(std::vector<double> values);
/// Returns 1 / (mse × seconds) with propagated error. The degrees of freedom follow by Welch (1947) and Satterthwaite
/// (1946).
Estimate efficiency_of(const Estimate& mse, const Estimate& seconds);
/// Returns a / b with the errors propagated as in efficiency_of.
Estimate ratio_of(const Estimate& a, const Estimate& b);
/// Returns the probability of a ratio at least this far above 1 if its true value is 1 (Welch's test on logarithms).
double p_value_above_one(const Estimate& ratio);

} // namespace duet::compare

// Figures with their uncertainty: what a handful of repeated measurements says, and how sure it is.
#pragma once

#include <vector>

namespace duet::compare {

/// P(|T| ≥ |t|) for T of Student's distribution with `dof` > 0 degrees of freedom, not necessarily whole.
double student_t_tail(double t, double dof);
/// The t with P(|T| ≥ t) = alpha, 0 < alpha < 1.
double student_t_critical(double alpha, double dof);
/// The significance of each of `tests` tests for which the odds of any false alarm are at most `alpha`: alpha / tests
/// (Bonferroni), which holds for dependent tests, too.
inline double shared_significance(double alpha, std::size_t tests) {
    return alpha / static_cast<double>(tests > 0 ? tests : 1);
}

/// A positive quantity and its band. The uncertainty is relative, and the band symmetric on a logarithmic scale:
/// value · exp(± t · relative_error), with Student's t. To first order in the relative error this is the usual band
/// (the delta method), but it never contains zero, and products and quotients propagate by adding squares.
struct Estimate {
    double value = 0;          ///< NaN: nothing was measured
    double relative_error = 0; ///< one standard error over the value; infinity: one measurement only
    double dof = 1;            ///< degrees of freedom behind that error

    /// The ends of the band that holds the truth with this confidence; 0 and infinity where the error is unknown.
    double low(double confidence = 0.95) const;
    double high(double confidence = 0.95) const;
};

/// The arithmetic mean of independent measurements.
Estimate mean_of(const std::vector<double>& values);
/// The median, for measurements some of which are disturbed. Its standard error is √(π/2) times that of the mean of
/// logarithms, as for a normal distribution and many values; of an even number the median is the middle two's mean.
Estimate median_of(std::vector<double> values);
/// 1 / (mse × seconds), errors propagated; degrees of freedom by Welch (1947) and Satterthwaite (1946).
Estimate efficiency_of(const Estimate& mse, const Estimate& seconds);
/// a / b, errors propagated in the same way.
Estimate ratio_of(const Estimate& a, const Estimate& b);
/// The odds of two equal quantities to be measured at least this different (Welch's test on logarithms).
double equality_p_value(const Estimate& a, const Estimate& b);

} // namespace duet::compare

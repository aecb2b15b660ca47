#include "compare/bench/estimate.h"

#include "common/vec/scalar.h"
#include "compare/timing.h"

#include <cmath>
#include <limits>

namespace duet::compare {

namespace {

/// Returns the continued fraction of the incomplete beta function by Lentz's method (Press et al. 2007,
/// "Numerical Recipes", §6.4). It converges quickly for x < (a + 1)/(a + b + 2).
double beta_fraction(double a, double b, double x) {
    constexpr double kTiny = 1e-300;
    const auto away_from_zero = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
    double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), result = d;
    for (int m = 1; m <= 10000; ++m) {
        const double m2 = 2.0 * m;
        const double even = m * (b - m) * x / ((a + m2 - 1) * (a + m2));
        const double odd = -(a + m) * (a + b + m) * x / ((a + m2) * (a + m2 + 1));
        double step = 1;
        for (const double coefficient : {even, odd}) {
            d = 1 / away_from_zero(1 + coefficient * d);
            c = away_from_zero(1 + coefficient / c);
            step = c * d;
            result *= step;
        }
        if (std::abs(step - 1) < 1e-15) break;
    }
    return result;
}

/// Returns the regularized incomplete beta function I_x(a, b). y = 1 − x is a parameter to preserve its digits.
double incomplete_beta(double a, double b, double x, double y) {
    if (x <= 0) return 0;
    if (y <= 0) return 1;
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log(y));
    return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a : 1 - front * beta_fraction(b, a, y) / b;
}

struct Moments {
    double mean = 0, deviation = 0; ///< of the sample; deviation with divisor n − 1
};
Moments moments(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    Moments m;
    for (const double v : values) m.mean += v / n;
    double squares = 0;
    for (const double v : values) squares += sqr(v - m.mean);
    m.deviation = values.size() > 1 ? std::sqrt(squares / (n - 1)) : std::numeric_limits<double>::infinity();
    return m;
}

double dof_of(std::size_t count) { return count > 1 ? static_cast<double>(count - 1) : 1.0; }

/// Returns a product or quotient of independent estimates, whose value is given, with its error and degrees of freedom.
Estimate combined(double value, const Estimate& a, const Estimate& b) {
    const double va = sqr(a.relative_error), vb = sqr(b.relative_error), sum = va + vb;
    if (!std::isfinite(sum)) return {value, std::numeric_limits<double>::infinity(), 1};
    const double dof = sum > 0 ? sqr(sum) / (sqr(va) / a.dof + sqr(vb) / b.dof) : a.dof + b.dof;
    return {value, std::sqrt(sum), dof};
}

} // namespace

double student_t_tail(double t, double dof) {
    const double t2 = sqr(t), sum = dof + t2;
    return std::isfinite(t2) ? incomplete_beta(dof / 2, 0.5, dof / sum, t2 / sum) : 0;
}

double student_t_critical(double alpha, double dof) {
    double low = 0, high = 1;
    while (student_t_tail(high, dof) > alpha && high < 1e300) high *= 2;
    for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
        const double middle = (low + high) / 2;
        (student_t_tail(middle, dof) > alpha ? low : high) = middle;
    }
    return (low + high) / 2;
}

double Estimate::low(double confidence) const {
    return value * std::exp(-student_t_critical(1 - confidence, dof) * relative_error);
}
double Estimate::high(double confidence) const {
    return value * std::exp(student_t_critical(1 - confidence, dof) * relative_error);
}

Estimate mean_of(const std::vector<double>& values) {
    if (values.empty()) return {std::numeric_limits<double>::quiet_NaN(), 0, 1};
    const auto [mean, deviation] = moments(values);
    const double error = deviation / std::sqrt(static_cast<double>(values.size()));
    return {mean, error > 0 ? error / mean : 0, dof_of(values.size())};
}

Estimate median_of(std::vector<double> values) {
    if (values.empty()) return {std::numeric_limits<double>::quiet_NaN(), 0, 1};
    const double middle = median(values);
    for (double& v : values) v = std::log(v);
    const double error = moments(values).deviation / std::sqrt(static_cast<double>(values.size()));
    return {middle, std::sqrt(kPiDouble / 2) * error, dof_of(values.size())};
}

Estimate efficiency_of(const Estimate& mse, const Estimate& seconds) {
    return combined(1 / (mse.value * seconds.value), mse, seconds);
}

Estimate ratio_of(const Estimate& a, const Estimate& b) { return combined(a.value / b.value, a, b); }

double p_value_above_one(const Estimate& ratio) {
    const double distance = std::log(ratio.value);
    if (!(distance > 0)) return 1;
    if (ratio.relative_error == 0) return 0; // equal in all trials of each run, but different between runs
    return student_t_tail(distance / ratio.relative_error, ratio.dof) / 2;
}

} // namespace duet::compare

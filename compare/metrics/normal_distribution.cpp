#include "compare/metrics/normal_distribution.h"

#include <cmath>

namespace duet::compare {

double two_sided_p(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

double upper_quantile(double p) {
    double low = 0, high = 40;
    for (int i = 0; i < 100; ++i) {
        const double middle = (low + high) / 2;
        (two_sided_p(middle) / 2 > p ? low : high) = middle;
    }
    return low;
}

// This form of 1 − (1 − p)^n does not lose a small p to rounding.
double sidak(double p, double tests) { return -std::expm1(tests * std::log1p(-p)); }

double sidak_level(double level, double tests) { return -std::expm1(std::log1p(-level) / tests); }

} // namespace duet::compare

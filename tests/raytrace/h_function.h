// Chandrasekhar's H-function, in which the light of a half space that scatters evenly has a closed form.
#pragma once

#include <cmath>
#include <vector>

namespace duet::raytrace {

/// Returns Chandrasekhar's H(μ) for isotropic scattering, by iteration of the form that converges for every albedo:
/// 1/H(μ) = √(1 − ϖ) + ½ϖ ∫ μ' H(μ') / (μ + μ') dμ' ("Radiative Transfer", 1950, §38).
class HFunction {
public:
    explicit HFunction(double albedo) : albedo_(albedo), values_(kPoints, 1.0) {
        for (int iteration = 0; iteration < 200; ++iteration) {
            std::vector<double> next(kPoints);
            for (int i = 0; i < kPoints; ++i) next[static_cast<std::size_t>(i)] = (*this)((i + 0.5) / kPoints);
            values_ = next;
        }
    }
    double operator()(double mu) const {
        double integral = 0;
        for (int i = 0; i < kPoints; ++i) {
            const double x = (i + 0.5) / kPoints;
            integral += x * values_[static_cast<std::size_t>(i)] / (mu + x) / kPoints;
        }
        return 1 / (std::sqrt(1 - albedo_) + 0.5 * albedo_ * integral);
    }

private:
    static constexpr int kPoints = 400;
    double albedo_;
    std::vector<double> values_;
};

} // namespace duet::raytrace

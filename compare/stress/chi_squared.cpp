#include "compare/stress/chi_squared.h"

#include "common/system/error.h"
#include "common/vec/frame.h"
#include "raytrace/sampling/sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace duet::compare {

namespace {

/// Returns the upper tail of the gamma distribution. It uses a series for x < a + 1 and a continued fraction
/// otherwise (Abramowitz and Stegun 1964, 6.5.29 and 6.5.31, the latter evaluated by Lentz's method).
double upper_gamma(double a, double x) {
    if (!(x > 0)) return 1;
    const double factor = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 10'000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
        return 1 - factor * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int n = 1; n < 10'000; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (std::abs(d * c - 1) < 1e-15) break;
    }
    return factor * h;
}

// The three-point Gauss-Legendre rule on [−1, 1] is exact for polynomials of degree 5.
constexpr std::array<double, 3> kNodes{-0.774596669241483377, 0, 0.774596669241483377};
constexpr std::array<double, 3> kWeights{5.0 / 9, 8.0 / 9, 5.0 / 9};

/// Returns ∫ f over [x0, x1] × [y0, y1], divided into n × n cells.
template <typename F> double quadrature(F f, double x0, double x1, double y0, double y1, int n) {
    const double dx = (x1 - x0) / n, dy = (y1 - y0) / n;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t l = 0; l < 3; ++l)
                    sum += kWeights[k] * kWeights[l] *
                           f(x0 + dx * (i + 0.5 + 0.5 * kNodes[k]), y0 + dy * (j + 0.5 + 0.5 * kNodes[l]));
    return sum * dx * dy / 4;
}

} // namespace

double chi_squared_tail(double statistic, int degrees_of_freedom) {
    return upper_gamma(0.5 * degrees_of_freedom, 0.5 * statistic);
}

ChiSquared chi_squared(const std::vector<double>& observed, const std::vector<double>& expected) {
    DUET_CHECK_EQ(observed.size(), expected.size());
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });

    double statistic = 0, pooled_observed = 0, pooled_expected = 0, worst = 0;
    std::size_t worst_bin = 0;
    int bins = 0;
    const auto add = [&](double o, double e, std::size_t bin) {
        const double part = (o - e) * (o - e) / e;
        statistic += part;
        ++bins;
        if (part > worst) worst = part, worst_bin = bin;
    };
    for (const std::size_t i : order) {
        if (expected[i] >= 5) {
            if (pooled_expected >= 5) add(pooled_observed, pooled_expected, i), pooled_observed = pooled_expected = 0;
            add(observed[i] + pooled_observed, expected[i] + pooled_expected, i);
            pooled_observed = pooled_expected = 0;
        } else {
            pooled_observed += observed[i];
            pooled_expected += expected[i];
        }
    }
    const int freedom = std::max(bins - 1, 1);
    return {chi_squared_tail(statistic, freedom),
            message("chi-squared ", statistic, " with ", freedom, " degrees of freedom; worst bin ", worst_bin, ": ",
                    observed[worst_bin], " samples, ", expected[worst_bin], " expected")};
}

DirectionResult test_directions(const DirectionTest& test, const DirectionSampler& sample,
                                const DirectionDensity& pdf) {
    const Frame frame = frame_from_normal(test.axis);
    const auto cells = static_cast<std::size_t>(test.rings * test.sectors);
    const auto border = [&](int ring) { return 2 * std::pow(static_cast<double>(ring) / test.rings, test.axis_power); };

    std::vector<double> observed(cells + 1), expected(cells + 1);
    Sampler sampler(SamplerKind::kIndependent, test.seed, 1);
    for (int i = 0; i < test.samples; ++i) {
        sampler.start(0, 0, static_cast<std::uint32_t>(i));
        const std::optional<Vec3> w = sample(sampler.get_2d());
        if (!w) {
            ++observed[cells];
            continue;
        }
        const Vec3d local(frame.to_local(*w));
        // This computes 1 − cos θ without cancellation for small θ.
        const double sin2 = local.x * local.x + local.y * local.y;
        const double gap = local.z > 0 ? sin2 / (1 + std::sqrt(std::max(0.0, 1 - sin2))) : 1 - local.z;
        const double phi = std::atan2(local.y, local.x);
        const int ring =
            std::clamp(static_cast<int>(std::pow(gap / 2, 1 / test.axis_power) * test.rings), 0, test.rings - 1);
        const int sector =
            std::clamp(static_cast<int>((phi / (2 * kPiDouble) + 0.5) * test.sectors), 0, test.sectors - 1);
        ++observed[static_cast<std::size_t>(ring * test.sectors + sector)];
    }

    const auto density = [&](double gap, double phi) {
        const double r = std::sqrt(gap * (2 - gap));
        return pdf(frame.to_world(Vec3(Vec3d(r * std::cos(phi), r * std::sin(phi), 1 - gap))));
    };
    double integral = 0;
    for (int ring = 0; ring < test.rings; ++ring)
        for (int sector = 0; sector < test.sectors; ++sector) {
            const double step = 2 * kPiDouble / test.sectors, phi = step * sector - kPiDouble;
            const double mass = quadrature(density, border(ring), border(ring + 1), phi, phi + step, test.subdivisions);
            expected[static_cast<std::size_t>(ring * test.sectors + sector)] = mass * test.samples;
            integral += mass;
        }
    // The expected fraction of draws without a sample is 1 minus the integral of the density. If no draw failed, the
    // deviation of the integral from 1 is attributed to the quadrature, and the caller must check the integral.
    if (observed[cells] > 0)
        expected[cells] = std::max(0.0, (1 - integral) * test.samples);
    else
        for (double& e : expected) e /= integral;
    return {chi_squared(observed, expected), integral};
}

} // namespace duet::compare

#include "compare/metrics/flip_filters.h"

#include "common/vec/scalar.h"

#include <numeric>

namespace duet::compare {

namespace {

using Taps = std::vector<double>;

template <typename Value> Taps taps(int radius, const Value& value_at) {
    Taps result;
    for (int x = -radius; x <= radius; ++x) result.push_back(value_at(static_cast<double>(x)));
    return result;
}

double sum(const Taps& t) { return std::accumulate(t.begin(), t.end(), 0.0); }

Kernel scaled(const Taps& t, double factor) {
    Kernel kernel;
    for (const double tap : t) kernel.push_back(static_cast<float>(tap * factor));
    return kernel;
}

/// Scales positive taps to the sum 1 and negative taps to the sum −1.
Kernel balanced(const Taps& t) {
    double positive = 0, negative = 0;
    for (const double tap : t) (tap > 0 ? positive : negative) += std::abs(tap);
    Kernel kernel;
    for (const double tap : t) kernel.push_back(static_cast<float>(tap / (tap > 0 ? positive : negative)));
    return kernel;
}

/// Holds a term a √(π/b) exp(−π² z/b) of a contrast sensitivity function, with z in degrees squared (Table 1).
struct Sensitivity {
    double a, b;
};
constexpr Sensitivity kLightness{1, 0.0047}, kRedness{1, 0.0053}, kBlueness[2] = {{34.1, 0.04}, {13.5, 0.025}};

} // namespace

// A Gaussian of x² + y² is the product of a Gaussian of x and one of y, and so is its derivative by x. The
// papers' kernels are square and normalized by sums over the square, which are products of sums as well.
// Nothing is approximated here.
std::array<SeparableFilter, kFlipFilters> flip_filters(double pixels_per_degree) {
    // All contrast filters extend to three standard deviations of the widest one.
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kBlueness[0].b / 2) / kPiDouble * pixels_per_degree));
    const auto gaussian = [&](Sensitivity s) {
        return taps(radius, [&](double x) { return std::exp(-sqr(kPiDouble * x / pixels_per_degree) / s.b); });
    };
    const Taps lightness = gaussian(kLightness), redness = gaussian(kRedness);
    const Taps wide = gaussian(kBlueness[0]), narrow = gaussian(kBlueness[1]);
    const auto volume = [](Sensitivity s, const Taps& t) { return s.a * std::sqrt(kPiDouble / s.b) * sqr(sum(t)); };
    const double wide_volume = volume(kBlueness[0], wide), narrow_volume = volume(kBlueness[1], narrow);
    const double both = wide_volume + narrow_volume;

    // The peak-to-trough distance of the human edge detector is 0.082 degrees, two standard deviations (§4.2.1).
    const double sigma = 0.5 * 0.082 * pixels_per_degree;
    const int reach = static_cast<int>(std::ceil(3 * sigma));
    const auto bell = [&](double x) { return std::exp(-sqr(x / sigma) / 2); };
    const Taps blur = taps(reach, bell);
    const Kernel smooth = scaled(blur, 1 / sum(blur));
    const Kernel slope = balanced(taps(reach, [&](double x) { return -x * bell(x); }));
    const Kernel bend = balanced(taps(reach, [&](double x) { return (sqr(x / sigma) - 1) * bell(x); }));

    const auto normal = [](const Taps& t) { return scaled(t, 1 / sum(t)); };
    return {{{0, normal(lightness), normal(lightness)},
             {1, normal(redness), normal(redness)},
             {2, normal(narrow), scaled(narrow, narrow_volume / both / sum(narrow))},
             {2, normal(wide), scaled(wide, wide_volume / both / sum(wide))},
             {0, slope, smooth},
             {0, smooth, slope},
             {0, bend, smooth},
             {0, smooth, bend}}};
}

} // namespace duet::compare

#include "raytrace/sampling/pixel_filter.h"

#include "common/system/name_table.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

constexpr NameTable<FilterKind, 2> kNames{
    "filter", {{{"box", FilterKind::kBox}, {"blackman-harris", FilterKind::kBlackmanHarris}}}};

/// Returns the integral from −r to x of the four-term Blackman-Harris window over [−r, r], divided by the integral
/// of the whole window (Harris 1978, "On the Use of Windows for Harmonic Analysis", table I, −92 dB).
double blackman_harris_below(double x, double r) {
    constexpr double a0 = 0.35875, a1 = 0.48829, a2 = 0.14128, a3 = 0.01168;
    // The window is a0 − a1 cos 2πt + a2 cos 4πt − a3 cos 6πt.
    const double t = (x + r) / (2 * r), two_pi = 2 * kPiDouble;
    const double cosine_integral =
        -a1 * std::sin(two_pi * t) + a2 / 2 * std::sin(2 * two_pi * t) - a3 / 3 * std::sin(3 * two_pi * t);
    return t + cosine_integral / (two_pi * a0);
}

std::vector<double> blackman_harris_quantiles() {
    constexpr double kRadius = 1.5;
    constexpr std::size_t kSteps = 1024;
    std::vector<double> quantiles(kSteps + 1);
    for (std::size_t i = 0; i <= kSteps; ++i) {
        const double target = static_cast<double>(i) / kSteps;
        double low = -kRadius, high = kRadius; // 60 bisections give the full precision of double
        for (int step = 0; step < 60; ++step) {
            const double middle = (low + high) / 2;
            (blackman_harris_below(middle, kRadius) < target ? low : high) = middle;
        }
        quantiles[i] = (low + high) / 2;
    }
    // Three quantiles are known exactly: the two ends, where the window vanishes, and the center.
    quantiles.front() = -kRadius;
    quantiles.back() = kRadius;
    quantiles[kSteps / 2] = 0;
    return quantiles;
}

} // namespace

FilterKind filter_kind(std::string_view name) { return kNames.value(name); }

std::string_view filter_name(FilterKind kind) { return kNames.name(kind); }

PixelFilter::PixelFilter(FilterKind kind) {
    if (kind == FilterKind::kBlackmanHarris) quantiles_ = blackman_harris_quantiles();
}

double PixelFilter::sample_axis(double u) const {
    const double position = u * static_cast<double>(quantiles_.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(position), quantiles_.size() - 2);
    return lerp(quantiles_[i], quantiles_[i + 1], position - static_cast<double>(i));
}

} // namespace duet

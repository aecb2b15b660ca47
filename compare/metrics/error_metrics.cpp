#include "compare/metrics/error_metrics.h"

#include "compare/metrics/same_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace duet::compare {

namespace {

/// This is the fraction of the pixels that relmse_trimmed excludes. In many images a few fireflies cause most of the
/// relMSE.
constexpr double kTrimmedShare = 0.001;

struct Sums {
    double squared = 0, absolute = 0, relative = 0, symmetric = 0;
    Rgbd differences;

    void add(Rgbd value, Rgbd reference) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double difference = value[c] - reference[c], square = sqr(difference);
            squared += square;
            absolute += std::abs(difference);
            relative += relative_square(square, reference[c]);
            symmetric += std::abs(difference) / (std::abs(value[c]) + std::abs(reference[c]) + kRelativeFloor);
        }
        differences += value - reference;
    }
    void add(const Sums& s) {
        squared += s.squared;
        absolute += s.absolute;
        relative += s.relative;
        symmetric += s.symmetric;
        differences += s.differences;
    }
};

bool has_nan(Rgb c) { return std::isnan(c.r) || std::isnan(c.g) || std::isnan(c.b); }
bool has_infinity(Rgb c) { return std::isinf(c.r) || std::isinf(c.g) || std::isinf(c.b); }

/// Returns the mean of the relative squared errors, one per pixel, without the largest fraction kTrimmedShare.
double trimmed_mean(std::vector<double>& errors) {
    const std::size_t kept =
        errors.size() - static_cast<std::size_t>(kTrimmedShare * static_cast<double>(errors.size()));
    if (kept < errors.size())
        std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(kept), errors.end());
    double sum = 0;
    for (std::size_t i = 0; i < kept; ++i) sum += errors[i];
    return sum / static_cast<double>(kept);
}

/// Counts non-finite values in a pixel of A and B. Returns true if there are any.
bool count_unusable(ErrorMetrics& metrics, Rgb a, Rgb b) {
    metrics.nan_a += has_nan(a);
    metrics.nan_b += has_nan(b);
    metrics.infinite_a += has_infinity(a);
    metrics.infinite_b += has_infinity(b);
    metrics.non_finite_a += !is_finite(a);
    metrics.non_finite_b += !is_finite(b);
    return !is_finite(a) || !is_finite(b);
}

} // namespace

ErrorMetrics error_metrics(const ImageRgb& a, const ImageRgb& b) {
    check_same_size(a, b);
    ErrorMetrics metrics;
    metrics.worst = -1;
    std::vector<double> relative;
    relative.reserve(a.size());
    Sums total;
    for (int y = 0; y < a.height(); ++y) {
        Sums row; // summed per row first, because the rounding error of a sum grows with its length
        for (int x = 0; x < a.width(); ++x) {
            if (count_unusable(metrics, a(x, y), b(x, y))) continue;
            const Rgbd value(a(x, y)), reference(b(x, y)), difference = value - reference;
            Sums pixel;
            pixel.add(value, reference);
            row.add(pixel);
            relative.push_back(pixel.relative / 3);
            ++metrics.pixels;
            const double largest =
                max_component(Rgbd(std::abs(difference.r), std::abs(difference.g), std::abs(difference.b)));
            if (largest > metrics.worst) {
                metrics.worst = largest;
                metrics.worst_x = x;
                metrics.worst_y = y;
            }
        }
        total.add(row);
    }
    const double pixels = static_cast<double>(metrics.pixels);
    metrics.mse = total.squared / (3 * pixels); // 0 / 0 gives NaN, as documented
    metrics.rmse = std::sqrt(metrics.mse);
    metrics.mae = total.absolute / (3 * pixels);
    metrics.psnr = -10 * std::log10(metrics.mse);
    metrics.relmse = total.relative / (3 * pixels);
    metrics.relmse_trimmed = trimmed_mean(relative);
    metrics.smape = total.symmetric / (3 * pixels);
    metrics.mean_signed_error = total.differences / pixels;
    if (metrics.pixels == 0) metrics.worst = std::numeric_limits<double>::quiet_NaN();
    return metrics;
}

} // namespace duet::compare

#include "compare/metrics/error_metrics.h"

#include <cmath>
#include <limits>

namespace duet::compare {

namespace {

/// Keeps zero references from dividing by zero, and dark ones from dominating.
constexpr double kRelativeFloor = 0.01;

struct Sums {
    double squared = 0, absolute = 0, relative = 0;
    Rgbd differences;

    void add(Rgbd difference, Rgbd reference) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double square = sqr(difference[c]);
            squared += square;
            absolute += std::abs(difference[c]);
            relative += square / (sqr(reference[c]) + kRelativeFloor);
        }
        differences += difference;
    }
    void add(const Sums& s) {
        squared += s.squared;
        absolute += s.absolute;
        relative += s.relative;
        differences += s.differences;
    }
};

} // namespace

ErrorMetrics error_metrics(const ImageRgb& a, const ImageRgb& b) {
    if (a.width() != b.width() || a.height() != b.height())
        throw Error(
            message("the pictures differ in size: ", a.width(), "x", a.height(), " and ", b.width(), "x", b.height()));
    ErrorMetrics metrics;
    metrics.worst = -1;
    Sums total;
    for (int y = 0; y < a.height(); ++y) {
        Sums row; // summed by row first: the error of a long sum grows with its length
        for (int x = 0; x < a.width(); ++x) {
            const Rgbd value(a(x, y)), reference(b(x, y));
            if (!is_finite(value)) ++metrics.non_finite_a;
            if (!is_finite(reference)) ++metrics.non_finite_b;
            if (!is_finite(value) || !is_finite(reference)) continue;
            const Rgbd difference = value - reference;
            row.add(difference, reference);
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
    metrics.mse = total.squared / (3 * pixels); // 0 / 0: NaN, as promised
    metrics.rmse = std::sqrt(metrics.mse);
    metrics.mae = total.absolute / (3 * pixels);
    metrics.psnr = -10 * std::log10(metrics.mse);
    metrics.relmse = total.relative / (3 * pixels);
    metrics.mean_signed_error = total.differences / pixels;
    if (metrics.pixels == 0) metrics.worst = std::numeric_limits<double>::quiet_NaN();
    return metrics;
}

} // namespace duet::compare

// This header computes means of renders and their standard errors, for statistical tests.
#pragma once

#include "raytrace/render.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace duet::raytrace {

inline Rgbd mean_of(const ImageRgb& image) {
    Rgbd sum;
    for (const Rgb& pixel : image) sum += Rgbd(pixel);
    return sum / static_cast<double>(image.size());
}

inline Rendering render_scene(const Scene& scene, int size, const PathTracerSettings& settings) {
    Control control;
    return render(prepare(scene, settings), View{scene.camera, size, size}, settings, control);
}

/// Holds the mean of an image's green channel over independent seeds, and the standard error of that mean.
struct Estimate {
    double mean = 0, error = 0;
};
inline Estimate estimate(const Scene& scene, int size, PathTracerSettings settings, int seeds = 10) {
    std::vector<double> means;
    for (int seed = 0; seed < seeds; ++seed) {
        settings.seed = static_cast<std::uint64_t>(seed + 1);
        means.push_back(mean_of(render_scene(scene, size, settings).radiance).g);
    }
    Estimate e;
    for (const double m : means) e.mean += m / seeds;
    double squares = 0;
    for (const double m : means) squares += (m - e.mean) * (m - e.mean);
    e.error = std::sqrt(squares / (seeds - 1) / seeds);
    return e;
}

/// Checks that two estimates, or an estimate and a value, are less than six standard errors apart. With ten seeds each,
/// the distribution is Student's with about 18 and 9 degrees of freedom: the check fails by chance once in 90,000 and
/// once in 5,000 times.
inline void check_equal_means(const Estimate& a, const Estimate& b) {
    CAPTURE(a.mean);
    CAPTURE(a.error);
    CAPTURE(b.mean);
    CAPTURE(b.error);
    CHECK(std::abs(a.mean - b.mean) < 6 * std::hypot(a.error, b.error));
}

/// Compares the mean of these settings, which it returns, with that of the naive path tracer. The naive mean must have
/// at most this relative error, because agreement would otherwise prove little.
inline Estimate check_against_naive(const Scene& scene, int size, PathTracerSettings settings, int naive_samples,
                                    double largest_error = 0.01) {
    const Estimate path = estimate(scene, size, settings);
    settings.integrator = Integrator::kNaive;
    settings.samples_per_pixel = naive_samples;
    const Estimate naive = estimate(scene, size, settings);
    check_equal_means(path, naive);
    CHECK(naive.error < largest_error * naive.mean);
    return path;
}

} // namespace duet::raytrace

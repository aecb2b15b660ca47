// This header computes means of renders and their standard errors, for statistical tests.
#pragma once

#include "raytrace/render.h"

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

/// Returns the number of standard errors between two estimates, or between an estimate and a value. With ten seeds
/// each, the distribution is Student's with about 18 and 9 degrees of freedom: 6 is exceeded by chance once in 90,000
/// and once in 5,000 times.
inline double deviations(const Estimate& a, const Estimate& b) {
    return std::abs(a.mean - b.mean) / std::sqrt(a.error * a.error + b.error * b.error);
}

} // namespace duet::raytrace

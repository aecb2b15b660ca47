// This header compares images of the rasterizer with the path tracer's.
#pragma once

#include "raytrace/render.h"

namespace duet::test {

/// Returns the mean over pixels of |a − b|² / (b² + 0.01), as compare's relMSE does, but NaN if any pixel is NaN.
inline double relmse(const ImageRgb& a, const ImageRgb& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto x = static_cast<double>(a[i][c]), y = static_cast<double>(b[i][c]);
            sum += (x - y) * (x - y) / (y * y + 0.01);
        }
    return sum / (3 * static_cast<double>(a.size()));
}

/// Returns the mean of the green channel.
inline double mean_green(const ImageRgb& image) {
    double sum = 0;
    for (std::size_t i = 0; i < image.size(); ++i) sum += static_cast<double>(image[i].g);
    return sum / static_cast<double>(image.size());
}

inline ImageRgb path_traced(const Scene& scene, const View& view, int spp) {
    raytrace::PathTracerSettings settings;
    settings.samples_per_pixel = spp;
    Control control;
    return raytrace::render(raytrace::prepare(scene, settings), view, settings, control).radiance;
}

} // namespace duet::test

// This header provides a floor viewed from above and measures the fraction of the light that reaches it.
#pragma once

#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

namespace duet::test {

inline constexpr int kSize = 200;      ///< pixels
inline constexpr double kSquare = 4.0; ///< side of the visible part of the floor, in meters
/// A shadow map lookup blurs an edge over this many texels to each side, half of the B-spline's width.
inline constexpr double kFilterRadius = 1.5;

/// Returns a view straight down at [−2, 2]² of the floor, from below all shadow casters.
inline View over_floor(double height = 0.25) {
    Camera camera = look_orthographic({0, height, 0}, {0, 0, 0}, kSquare);
    camera.up = {0, 0, -1};
    return {camera, kSize, kSize};
}
inline Vec3d floor_point(int x, int y) {
    return {(x + 0.5) * kSquare / kSize - kSquare / 2, 0, (y + 0.5) * kSquare / kSize - kSquare / 2};
}

inline Scene floor_scene(float half = 4) {
    Scene scene;
    add(scene, QuadList{{{Vec3(-half, 0, half), Vec3(2 * half, 0, 0), Vec3(0, 0, -2 * half)}}});
    scene.camera = over_floor().camera;
    return scene;
}

/// Returns the fraction of the lights' direct light that reaches each pixel.
inline ImageFloat visible(const Scene& scene, const View& view, raster::RasterSettings settings = {}) {
    settings = direct_light_only(settings);
    const ImageRgb shaded = render(scene, view, settings).radiance;
    settings.shadows = false;
    const ImageRgb open = render(scene, view, settings).radiance;
    ImageFloat result(view.width, view.height);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = open[i].g > 0 ? shaded[i].g / open[i].g : 1;
    return result;
}

/// Compares visibility with a known shadow silhouette. `inside` returns how far within it a point is (negative
/// outside). Pixels farther than `reach` from it must be fully dark or fully lit, and the area must be right to
/// `tolerance` meters along `perimeter`.
template <typename Inside>
void check_outline(const ImageFloat& found, const Inside& inside, double reach, double perimeter, double tolerance) {
    constexpr double kPixel = kSquare / kSize;
    double area = 0, expected = 0;
    int wrong = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const double depth = inside(floor_point(x, y));
            area += 1 - static_cast<double>(found(x, y));
            expected += depth > 0;
            constexpr float kRounding = 1e-5f; // of the quotient
            if (depth > reach) wrong += found(x, y) > kRounding;
            if (depth < -reach) wrong += found(x, y) < 1 - kRounding;
        }
    CHECK(wrong == 0);
    // The reference classifies pixels by their centers, so it is off by up to half a pixel along the silhouette, and
    // by 1/8 on average.
    CHECK(std::abs(area - expected) * kPixel * kPixel < perimeter * (tolerance + kPixel / 8));
}

} // namespace duet::test

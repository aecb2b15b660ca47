// Assignment 6: one scene by two pipelines, and a report on what differs.
#pragma once

#include "common/image/image.h"
#include "common/vec/vec.h"
#include "tests/grading/lab.h"

#include <vector>

namespace duet::lab {

/// A matte triangle. It is seen from both sides.
struct Triangle {
    Vec3 a, b, c;
    Rgb albedo;
};

struct Scene {
    std::vector<Triangle> triangles;
    Vec3 to_sun; ///< the direction to the sun, of length 1
    Rgb sun;     ///< what a surface that faces the sun gets from it
    Rgb sky;     ///< what every surface gets, whatever its direction
};

/// A camera without a lens. It looks from eye to target, with up upward in the image.
struct Camera {
    Vec3 eye, target, up;
    float fov_degrees; ///< the vertical angle of view
    float near;        ///< what is nearer than this plane, in meters along the direction of view, is not seen
};

/// An image, and what each of its pixels sees.
struct Rendering {
    ImageRgb color;
    Image<int> triangle; ///< the index of the triangle that is seen; -1 where there is none
    ImageFloat distance; ///< in meters from the eye to the point that is seen; infinite where there is none
};

/// The color of a point: albedo · (sky + sun · max(0, n·to_sun)), where n is the triangle's unit normal on the side of
/// the eye. In shadow the sun counts nothing. Pixels that see no triangle are black.

/// The scene by projection of triangles: every triangle is clipped at the near plane and drawn into a depth buffer. The
/// pixel in column x and row y (row 0 is the top one) sees what is at its center (x + 0.5, y + 0.5). Without shadows.
Rendering rasterize(const Scene& scene, const Camera& camera, int width, int height);

/// The same image by a ray through the center of each pixel, with the sun's shadows where they are asked for.
Rendering ray_trace(const Scene& scene, const Camera& camera, int width, int height, bool shadows);

/// The index of the triangle that a ray through the point (x, y) of the image sees, in pixels from its upper left
/// corner; -1 where there is none.
int triangle_at(const Scene& scene, const Camera& camera, int width, int height, float x, float y);

/// Differences between an image and a reference b of the same size, over all pixels and all three channels.
struct Errors {
    double mse = 0;               ///< the mean of (a - b)²
    double rmse = 0;              ///< the root of that
    double relmse = 0;            ///< the mean of (a - b)² / (b² + 0.01)
    double mean_signed_error = 0; ///< the mean of a - b: positive where the image is too bright
};
Errors errors(const ImageRgb& image, const ImageRgb& reference);

/// How many pixels of two renderings agree. Each pixel counts once, in the first line that fits.
struct HitCounts {
    int same = 0; ///< both see the same triangle, or none
    int edge = 0; ///< one of the eight rays through (x ± 1/128 or x, y ± 1/128 or y) sees the rasterizer's triangle
    int tie = 0;  ///< both see a triangle, and the distances differ by at most 1e-5 of the larger
    int unexplained = 0; ///< all else: a mistake in one of the pipelines
};
HitCounts compare_hits(const Scene& scene, const Camera& camera, const Rendering& raster, const Rendering& traced);

/// The difference as an image: d = (luminance of the image - luminance of the reference) / range, at most 1 and at
/// least -1. Where d is positive, the pixel is (d, 0, 0), red; where it is negative, (0, 0, -d), blue. range > 0. The
/// luminance of a color is 0.2126 r + 0.7152 g + 0.0722 b.
ImageRgb difference_image(const ImageRgb& image, const ImageRgb& reference, float range);

} // namespace duet::lab

DUET_LAB(rasterize, ray_trace, triangle_at, errors, compare_hits, difference_image)

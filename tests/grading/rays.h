// Rays and triangles in double, and images by a function of the pixel: what the truth of several examiners is made of.
#pragma once

#include "common/image/image.h"
#include "common/vec/vec.h"

#include <limits>
#include <vector>

namespace duet::grading {

/// The t at which a ray meets a triangle; infinite where it doesn't. (Möller and Trumbore 1997)
template <typename Point> double hit_triangle(Point a, Point b, Point c, Vec3d origin, Vec3d direction) {
    const Vec3d from(a), ab = Vec3d(b) - from, ac = Vec3d(c) - from, p = cross(direction, ac), o = origin - from;
    const double determinant = dot(ab, p);
    if (determinant == 0) return std::numeric_limits<double>::infinity();
    const Vec3d q = cross(o, ab);
    const double u = dot(o, p) / determinant, v = dot(direction, q) / determinant;
    return u < 0 || v < 0 || u + v > 1 ? std::numeric_limits<double>::infinity() : dot(ac, q) / determinant;
}

/// An image whose pixels are color(x, y).
template <typename Color> auto each_pixel(int width, int height, const Color& color) {
    Image<decltype(color(0, 0))> image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image(x, y) = color(x, y);
    return image;
}

} // namespace duet::grading

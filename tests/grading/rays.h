// Rays, triangles and spheres in double, and images by a function of the pixel: what the truth of several examiners is
// made of.
#pragma once

#include "common/image/image.h"
#include "common/vec/vec.h"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace duet::grading {

/// The t at which a ray meets a triangle; infinite where it doesn't. (Möller and Trumbore 1997)
template <typename Point> double hit_triangle(Point a, Point b, Point c, Vec3d origin, Vec3d direction) {
    constexpr double kMiss = std::numeric_limits<double>::infinity();
    const Vec3d from(a), ab = Vec3d(b) - from, ac = Vec3d(c) - from, p = cross(direction, ac), o = origin - from;
    const double determinant = dot(ab, p);
    if (determinant == 0) return kMiss;
    const double inverse = 1 / determinant, u = dot(o, p) * inverse;
    if (u < 0 || u > 1) return kMiss; // most triangles are missed here
    const Vec3d q = cross(o, ab);
    const double v = dot(direction, q) * inverse;
    return v < 0 || u + v > 1 ? kMiss : dot(ac, q) * inverse;
}

/// Planes n · p = w, seen from the side of n, and spheres with the radius w.
struct Shapes {
    std::vector<Vec4d> planes, spheres;
};
struct ShapeHit {
    double t;
    Vec3d p, n;
};
/// What a ray of unit direction meets first, outsides alone.
inline std::optional<ShapeHit> first_hit(const Shapes& scene, Vec3d o, Vec3d d) {
    std::optional<ShapeHit> first;
    const auto offer = [&](double t, Vec3d n) {
        if (t > 1e-6 && (!first || t < first->t)) first = ShapeHit{t, o + d * t, n};
    };
    for (const Vec4d& q : scene.planes) {
        const Vec3d n(q.x, q.y, q.z);
        if (dot(n, d) < 0) offer((q.w - dot(n, o)) / dot(n, d), n);
    }
    for (const Vec4d& s : scene.spheres) {
        const Vec3d q = o - Vec3d(s.x, s.y, s.z);
        const double b = dot(q, d), root = b * b - dot(q, q) + s.w * s.w;
        if (root > 0) offer(-b - std::sqrt(root), (q + d * (-b - std::sqrt(root))) / s.w);
    }
    return first;
}

/// An image whose pixels are color(x, y).
template <typename Color> auto each_pixel(int width, int height, const Color& color) {
    Image<decltype(color(0, 0))> image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image(x, y) = color(x, y);
    return image;
}

} // namespace duet::grading

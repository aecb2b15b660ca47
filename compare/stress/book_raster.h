// The rasterizer of the books, for the naive columns: tinyrenderer's (Sokolov, lessons 2 to 5), in float.
#pragma once

#include "common/vec/matrix.h"

#include <array>

namespace duet::compare {

/// A vertex after the division by w, in pixels, whatever side of the eye it was on.
struct BookVertex {
    Vec2 pixel;
    float depth; ///< camera-space −z before the division
};
using BookTriangle = std::array<BookVertex, 3>;

inline BookVertex book_project(const Mat4& world_to_pixel, Vec3 p) {
    const Vec4 v = world_to_pixel * Vec4(p, 1.0f);
    return {{v.x / v.w, v.y / v.w}, v.w};
}

/// Barycentric coordinates by ratios of areas on the screen. NaN or infinite for a triangle without area.
inline Vec3 book_barycentrics(const BookTriangle& t, Vec2 p) {
    const auto area = [](Vec2 a, Vec2 b, Vec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); };
    const Vec2 a = t[0].pixel, b = t[1].pixel, c = t[2].pixel;
    return Vec3(area(p, b, c), area(p, c, a), area(p, a, b)) / area(a, b, c);
}

/// Inside where no barycentric coordinate is negative: a sample on a shared edge belongs to both triangles, or, by
/// rounding, to none.
inline bool book_covers(const BookTriangle& t, Vec2 p) {
    const Vec3 b = book_barycentrics(t, p);
    return b.x >= 0 && b.y >= 0 && b.z >= 0;
}

/// OpenGL's depth after the division, −1 at the near plane and 1 at the far one.
inline float book_z(float depth, float near, float far) {
    return (far + near) / (far - near) - 2 * far * near / ((far - near) * depth);
}

} // namespace duet::compare

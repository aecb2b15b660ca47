// This header declares the textbook rasterizer of the naive columns: tinyrenderer's (Sokolov, lessons 2 to 5), in
// float.
#pragma once

#include "common/vec/matrix.h"

#include <array>

namespace duet::compare {

/// A TextbookVertex is a vertex after the perspective division, in pixels, even if it is behind the eye.
struct TextbookVertex {
    Vec2 pixel;
    float depth; ///< camera-space −z before the division
};
using TextbookTriangle = std::array<TextbookVertex, 3>;

/// Projects a point of world space. Nothing is clipped.
inline TextbookVertex textbook_project(const Mat4& world_to_pixel, Vec3 p) {
    const Vec4 v = world_to_pixel * Vec4(p, 1.0f);
    return {{v.x / v.w, v.y / v.w}, v.w};
}

/// Returns barycentric coordinates as ratios of areas in screen space. They are NaN or infinite for a triangle
/// without area.
inline Vec3 textbook_barycentrics(const TextbookTriangle& t, Vec2 p) {
    const auto area = [](Vec2 a, Vec2 b, Vec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); };
    const Vec2 a = t[0].pixel, b = t[1].pixel, c = t[2].pixel;
    return Vec3(area(p, b, c), area(p, c, a), area(p, a, b)) / area(a, b, c);
}

/// Returns whether no barycentric coordinate is negative. A sample on a shared edge belongs to both triangles or,
/// because of rounding, to neither.
inline bool textbook_covers(const TextbookTriangle& t, Vec2 p) {
    const Vec3 b = textbook_barycentrics(t, p);
    return b.x >= 0 && b.y >= 0 && b.z >= 0;
}

/// Returns OpenGL's depth after the perspective division: −1 at the near plane and 1 at the far plane.
inline float textbook_z(float depth, float near, float far) {
    return (far + near) / (far - near) - 2 * far * near / ((far - near) * depth);
}

} // namespace duet::compare

// Cutting off what lies behind the eye.
#pragma once

#include "raster/lessons/04-camera/mesh.h"
#include "raster/lessons/04-camera/transform.h"

#include <array>

namespace duet::lesson {

/// A vertex on its way to the picture.
struct Vertex {
    Vec4 clip; ///< in clip space, before the division by w
    Vec3 p, n; ///< point and normal in world space, for shading
    Vec2 uv;
};
using Triangle = std::array<Vertex, 3>;

/// The triangles of a mesh that is in world space already.
inline std::vector<Triangle> in_clip_space(const Mesh& world, const Mat4& clip_from_world) {
    std::vector<Triangle> triangles(world.size() / 3);
    for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
        const auto& [p, n, uv] = world[i];
        triangles[i / 3][i % 3] = {clip_from_world * Vec4(p, 1), p, n, uv};
    }
    return triangles;
}

/// The vertex at fraction t of the way from a to b. All is linear in clip space, so one t serves every attribute.
inline Vertex between(const Vertex& a, const Vertex& b, float t) {
    const float s = 1 - t;
    return {a.clip * s + b.clip * t, a.p * s + b.p * t, a.n * s + b.n * t, a.uv * s + b.uv * t};
}

/// The part of a triangle in front of the near plane (z >= 0 in clip space) as none, one or two triangles. The corners
/// are walked around; where an edge passes through the plane, the point of passage is a new corner.
/// (Sutherland and Hodgman 1974, "Reentrant Polygon Clipping")
inline std::vector<Triangle> clip_near(const Triangle& triangle) {
    std::vector<Vertex> polygon;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex &from = triangle[i], &to = triangle[(i + 1) % 3];
        if (from.clip.z >= 0) polygon.push_back(from);
        if ((from.clip.z >= 0) != (to.clip.z >= 0))
            polygon.push_back(between(from, to, from.clip.z / (from.clip.z - to.clip.z)));
    }
    std::vector<Triangle> triangles;
    for (std::size_t i = 2; i < polygon.size(); ++i) triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
    return triangles;
}

} // namespace duet::lesson

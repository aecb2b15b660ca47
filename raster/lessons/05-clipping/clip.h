// Cutting off what lies behind the eye.
#pragma once

#include "raster/lessons/04-camera/mesh.h"
#include "raster/lessons/04-camera/transform.h"

#include <array>

namespace duet::lesson {

/// A vertex on its way to the image.
struct Vertex {
    Vec4 clip; ///< in clip space, before the division by w
    Vec3 p, n; ///< point and normal in world space, for shading
    Vec2 uv;
};
using Triangle = std::array<Vertex, 3>;

/// The triangles of a mesh that is in world space already.
inline std::vector<Triangle> in_clip_space(const Mesh& world, const Mat4& clip_from_world) {
    std::vector<Triangle> triangles(world.size() / 3);
    for (std::size_t i = 0; i < 3 * triangles.size(); ++i)
        triangles[i / 3][i % 3] = {clip_from_world * Vec4(world[i].p, 1), world[i].p, world[i].n, world[i].uv};
    return triangles;
}

/// Where the edge from `in`, before the near plane, to `out`, behind it, crosses the plane. In clip space one t serves
/// all attributes. Both triangles of an edge use this order of the ends, so they get the same point, bit for bit.
inline Vertex crossing(const Vertex& in, const Vertex& out) {
    const float t = in.clip.z / (in.clip.z - out.clip.z), s = 1 - t;
    return {in.clip * s + out.clip * t, in.p * s + out.p * t, in.n * s + out.n * t, in.uv * s + out.uv * t};
}

/// The part of a triangle in front of the near plane (z >= 0 in clip space) as none, one or two triangles. The corners
/// are walked around; where an edge passes through the plane is a new corner.
/// (Sutherland and Hodgman 1974, "Reentrant Polygon Clipping")
inline std::vector<Triangle> clip_near(const Triangle& triangle) {
    std::vector<Vertex> polygon;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex &from = triangle[i], &to = triangle[(i + 1) % 3];
        if (from.clip.z >= 0) polygon.push_back(from);
        if (from.clip.z >= 0 && to.clip.z < 0) polygon.push_back(crossing(from, to));
        if (from.clip.z < 0 && to.clip.z >= 0) polygon.push_back(crossing(to, from));
    }
    std::vector<Triangle> triangles;
    for (std::size_t i = 2; i < polygon.size(); ++i) triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
    return triangles;
}

} // namespace duet::lesson

// Shapes as plain triangle meshes, for renderers that know nothing else.
#pragma once

#include "common/scene/scene.h"

#include <cstdint>
#include <vector>

namespace duet::compare {

/// Triangles with what belongs to each of their corners, three corners a triangle, counter-clockwise from the front.
struct TriangleSoup {
    std::vector<Vec3> positions;         ///< shared vertices
    std::vector<std::int32_t> triangles; ///< three indices each
    std::vector<std::int32_t> slots;     ///< material slot, one a triangle
    std::vector<Vec3> normals;           ///< one a corner, unit; or empty: flat
    std::vector<Vec2> uvs;               ///< one a corner
    std::vector<Vec3> object_positions;  ///< one a corner, in the object's own space
};

/// A mesh or quads in world space under `to_world`; what it mirrors keeps its front by an exchange of corners.
TriangleSoup world_triangles(const Shape& shape, const Mat4& to_world);

/// The unit sphere about the origin in rings and sectors, its vertices on the sphere, with smooth normals and the
/// texture coordinates of sphere_uv. No vertex is more than π/rings from the next; faces lie within 1 −
/// cos(π/(2·rings)) below the sphere's surface.
TriangleSoup sphere_triangles(int rings);
constexpr std::int64_t sphere_triangle_count(int rings) { return 4 * std::int64_t{rings} * (rings - 1); }

/// Of all triangles.
double area(const TriangleSoup& soup);

} // namespace duet::compare

// This file defines the shapes of the renderer: sphere, list of quads (one, or the six of a box) and triangle mesh.
#pragma once

#include "common/vec/box.h"
#include "common/vec/matrix.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace duet {

/// A sphere has a center and a radius, in meters; the radius is positive.
struct Sphere {
    Vec3 center;
    float radius = 1;
};

/// A quad is the parallelogram corner + a·u + b·v with a and b in [0, 1]. Its normal is u × v; an emissive quad
/// emits on that side.
struct Quad {
    Vec3 corner, u, v;
};

/// Returns corner, corner + u, corner + u + v and corner + v. Both pipelines use exactly these floats.
inline std::array<Vec3, 4> corners(const Quad& q) {
    return {q.corner, q.corner + q.u, (q.corner + q.u) + q.v, q.corner + q.v};
}

/// A list of quads is one shape; a box has six of them.
struct QuadList {
    std::vector<Quad> quads;
};

/// A mesh consists of triangles with shared vertices. The vertices are in counter-clockwise order seen from the front.
struct Mesh {
    std::vector<Vec3> positions{};
    std::vector<Vec3> normals{}; ///< one unit normal per position, or empty for flat shading
    std::vector<Vec2> uvs{};     ///< one uv per position, or empty: barycentric (u, v) of the triangle
    std::vector<std::array<std::uint32_t, 3>> triangles{}; ///< indices of the vertices
    std::vector<std::uint16_t> material_slots{};           ///< one slot per triangle, or empty: all 0
    /// A closed mesh fulfills two conditions. First, each edge, identified by the positions of its ends, is shared by
    /// two triangles that traverse it in opposite directions. Second, each connected component encloses a positive
    /// volume, so its triangles face outward. finish_scene() sets this; before, it may be empty.
    std::optional<bool> closed{};
};

using Shape = std::variant<Sphere, QuadList, Mesh>;

/// Returns the number of triangles of a mesh or of quads of a list, or 1 for a sphere.
std::uint32_t primitive_count(const Shape& shape);
/// Returns the bounds of a shape under an affine map. They are conservative: they contain every point that
/// surface_point() returns.
Box3 bounds(const Shape& shape, const Mat4& transform);
/// Returns the six quads of an axis-aligned box in the order −x, +x, −y, +y, −z, +z; their normals point outward.
/// Requires low < high on each axis. Adjacent quads have exactly the same corners, so no ray passes between them. To
/// achieve this, the corner `high` moves by the rounding error of low + (high − low).
QuadList box_quads(Vec3 low, Vec3 high);
/// Returns an index for each position: that of one of the positions equal to it. Equal positions have the same index.
std::vector<std::uint32_t> weld(const std::vector<Vec3>& positions);
/// Returns whether a mesh is closed and oriented outward, as defined at Mesh::closed. Vertices at the same position
/// count as one vertex.
bool is_closed_outwards(const Mesh& mesh);

} // namespace duet

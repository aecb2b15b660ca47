// The closed set of shapes: sphere, quads (one, or the six of a box), triangle mesh.
#pragma once

#include "common/vec/box.h"
#include "common/vec/matrix.h"

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace duet {

struct Sphere {
    Vec3 center;
    float radius = 1;
};

/// The parallelogram corner + a·u + b·v, a and b in [0, 1]. Its normal, and the side it emits on, is u × v.
struct Quad {
    Vec3 corner, u, v;
};

/// corner, corner + u, corner + u + v, corner + v: the floats that both pipelines draw and intersect.
inline std::array<Vec3, 4> corners(const Quad& q) {
    return {q.corner, q.corner + q.u, (q.corner + q.u) + q.v, q.corner + q.v};
}

struct QuadList {
    std::vector<Quad> quads;
};

/// Triangles over shared vertices, counter-clockwise seen from the front.
struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals; ///< one a position, unit length, or empty: flat
    std::vector<Vec2> uvs;     ///< one a position, or empty: the triangle's own (u, v) is used
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint16_t> material_slots; ///< one a triangle, or empty: all 0
    bool closed = false; ///< each edge, by position, is shared by two triangles that run it in opposite directions,
                         ///< and each connected part encloses a positive volume: it is oriented outwards
};

using Shape = std::variant<Sphere, QuadList, Mesh>;

std::uint32_t primitive_count(const Shape& shape);
/// Bounds of the shape under an affine map; conservative (they contain every point the surface routines return).
Box3 bounds(const Shape& shape, const Mat4& transform);
/// The six quads of an axis-aligned box, normals outwards: −x, +x, −y, +y, −z, +z. low < high on each axis. Neighbours
/// have the very same corners, so no ray slips between them; for that `high` moves by its rounding.
QuadList box_quads(Vec3 low, Vec3 high);
/// Whether the mesh is closed and oriented outwards, judged by position: see Mesh::closed.
bool is_closed_outwards(const Mesh& mesh);

} // namespace duet

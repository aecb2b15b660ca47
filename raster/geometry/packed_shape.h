// Defines a triangulated shape in the layout that shading reads: a mesh, or quads, each of which is drawn as two
// triangles.
#pragma once

#include "common/geometry/shape.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace duet::raster {

/// Selects how interpolated barycentrics map to Hit::u and Hit::v.
enum class TriangleKind : std::uint8_t {
    kTriangle,   ///< corners a, b, c
    kQuadFirst,  ///< corner, +u, +u+v
    kQuadSecond, ///< corner, +u+v, +v
};

/// Stores all attributes of a vertex in 32 bytes, half a cache line.
struct alignas(32) PackedVertex {
    Vec3 p;
    float u = 0; ///< texture coordinates (u, v); 0 where the mesh has none
    Vec3 n;      ///< (0, 0, 0) where the shape has none
    float v = 0;
};

/// Stores the packed vertices and triangles of a shape; empty for a sphere. It is movable but not copyable, because
/// `triangles` may point into `halves`.
struct PackedShape {
    using Triangle = std::array<std::uint32_t, 3>; ///< vertex indices

    std::vector<PackedVertex> vertices;
    std::vector<Triangle> halves;        ///< two per quad: (corner, +u, +u+v) and (corner, +u+v, +v)
    std::span<const Triangle> triangles; ///< `halves`, or the mesh's own triangles
    bool has_uvs = false;

    explicit PackedShape(const Shape& shape);
    PackedShape(PackedShape&&) = default;
    PackedShape& operator=(PackedShape&&) = default;

    bool quads() const { return !halves.empty(); }
    /// Returns the Hit::primitive index of a triangle.
    std::size_t primitive(std::size_t triangle) const { return quads() ? triangle / 2 : triangle; }
    TriangleKind triangle_kind(std::size_t triangle) const {
        return !quads()            ? TriangleKind::kTriangle
               : triangle % 2 == 0 ? TriangleKind::kQuadFirst
                                   : TriangleKind::kQuadSecond;
    }

private:
    void pack(const Mesh& mesh);
    void pack(const QuadList& list);
};

} // namespace duet::raster

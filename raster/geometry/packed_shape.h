// A shape of triangles as shading reads it: a mesh, or quads, each of which is drawn as two triangles.
#pragma once

#include "common/geometry/shape.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace duet::raster {

/// What an interpolated barycentric triple means for Hit::u and v.
enum class Piece : std::uint8_t {
    kTriangle,   ///< corners a, b, c
    kQuadFirst,  ///< corner, +u, +u+v
    kQuadSecond, ///< corner, +u+v, +v
};

/// A vertex whole in half a line of the cache.
struct alignas(32) PackedVertex {
    Vec3 p;
    float u = 0; ///< with v: texture coordinates; 0 where the mesh has none
    Vec3 n;      ///< (0, 0, 0) where the shape has none
    float v = 0;
};

/// Of a sphere all is empty. Moves with what it points to, and is not copied.
struct PackedShape {
    using Triangle = std::array<std::uint32_t, 3>; ///< numbers of its vertices

    std::vector<PackedVertex> vertices;
    std::vector<Triangle> halves;        ///< of quads, two each: corner, +u, +u+v; corner, +u+v, +v
    std::span<const Triangle> triangles; ///< those, or the mesh's own
    bool has_uvs = false;

    explicit PackedShape(const Shape& shape);
    PackedShape(PackedShape&&) = default;
    PackedShape& operator=(PackedShape&&) = default;

    bool quads() const { return !halves.empty(); }
    /// Hit::primitive of a triangle.
    std::size_t primitive(std::size_t triangle) const { return quads() ? triangle / 2 : triangle; }
    Piece piece(std::size_t triangle) const {
        return !quads() ? Piece::kTriangle : triangle % 2 == 0 ? Piece::kQuadFirst : Piece::kQuadSecond;
    }

private:
    void pack(const Mesh& mesh);
    void pack(const QuadList& list);
};

} // namespace duet::raster

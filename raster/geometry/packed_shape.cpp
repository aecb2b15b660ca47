#include "raster/geometry/packed_shape.h"

namespace duet::raster {

PackedShape::PackedShape(const Shape& shape) {
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) pack(*mesh);
    if (const QuadList* list = std::get_if<QuadList>(&shape)) pack(*list);
}

void PackedShape::pack(const Mesh& mesh) {
    vertices.resize(mesh.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        vertices[i].p = mesh.positions[i];
        if (!mesh.normals.empty()) vertices[i].n = mesh.normals[i];
        if (!mesh.uvs.empty()) vertices[i].u = mesh.uvs[i].x, vertices[i].v = mesh.uvs[i].y;
    }
    triangles = mesh.triangles;
    has_uvs = !mesh.uvs.empty();
}

void PackedShape::pack(const QuadList& list) {
    constexpr std::array<Vec2, 4> kUv{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
    for (const Quad& quad : list.quads) {
        const auto first = static_cast<std::uint32_t>(vertices.size());
        const std::array<Vec3, 4> p = corners(quad);
        for (std::size_t k = 0; k < 4; ++k) vertices.push_back({.p = p[k], .u = kUv[k].x, .n = {}, .v = kUv[k].y});
        halves.push_back({first, first + 1, first + 2});
        halves.push_back({first, first + 2, first + 3});
    }
    triangles = halves;
    has_uvs = true;
}

} // namespace duet::raster

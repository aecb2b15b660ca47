#include "raster/geometry/triangles.h"

#include <algorithm>

namespace duet::raster {

const Run& Triangles::run_of(std::uint32_t id, const Run& hint) const {
    if (id - hint.first_id < hint.count) return hint;
    const auto after = std::upper_bound(runs.begin(), runs.end(), id,
                                        [](std::uint32_t number, const Run& run) { return number < run.first_id; });
    return *(after - 1);
}

UnclippedTriangle Triangles::unclipped(const Run& run, std::uint32_t index) const {
    const Shape& of = shape(run);
    const TransformedObject& m = objects[run.object];
    if (const Mesh* mesh = std::get_if<Mesh>(&of)) {
        const auto& corner = mesh->triangles[index];
        return {pixel_vertex(m, mesh->positions[corner[0]]), pixel_vertex(m, mesh->positions[corner[1]]),
                pixel_vertex(m, mesh->positions[corner[2]]), TriangleKind::kTriangle};
    }
    const PrimitiveVertices corners = primitive_vertices(of, index / 2);
    const std::size_t half = index % 2; // halves are (corner, +u, +u+v) and (corner, +u+v, +v)
    return {pixel_vertex(m, corners.p[0]), pixel_vertex(m, corners.p[1 + half]), pixel_vertex(m, corners.p[2 + half]),
            half == 0 ? TriangleKind::kQuadFirst : TriangleKind::kQuadSecond};
}

} // namespace duet::raster

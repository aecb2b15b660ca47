#include "raster/geometry/simplify_mesh.h"

#include "common/sampling/hash.h"
#include "common/vec/box.h"

#include <bit>
#include <cmath>
#include <unordered_map>

namespace duet::raster {
namespace {

constexpr double kTextureCells = 16; ///< per unit of texture coordinates; vertices in different ones stay apart

/// Maps each key to an index, in the order of first use.
class Numbering {
public:
    std::uint32_t operator()(std::uint64_t key) {
        return numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
    }

private:
    std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
};

/// Adds the whole part of a number of any size to a key.
std::uint64_t add_floor(std::uint64_t key, double x) {
    return hash_combine(key, std::bit_cast<std::uint64_t>(std::floor(x) + 0.0)); // + 0.0: −0 and 0 are one number
}

/// Returns a number for the cell of a grid that contains p; distinct for distinct cells, except by a rare collision.
std::uint64_t cell_key(Vec3d p, Vec3d origin, double cell) {
    std::uint64_t key = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) key = add_floor(key, (p[axis] - origin[axis]) / cell);
    return key;
}

/// Returns a number for what vertices of one cell must have in common to become one vertex: the cell's number, the
/// longest axis of the normal, and the place in the texture.
std::uint64_t vertex_key(const Mesh& mesh, std::size_t i, std::uint32_t cell) {
    std::uint64_t key = cell;
    if (!mesh.normals.empty()) {
        const Vec3 n = mesh.normals[i];
        const std::size_t axis = longest_axis(abs(n));
        key = hash_combine(key, 2 * axis + (n[axis] < 0 ? 1 : 0));
    }
    if (!mesh.uvs.empty())
        for (const float x : {mesh.uvs[i].x, mesh.uvs[i].y})
            key = add_floor(key, static_cast<double>(x) * kTextureCells);
    return key;
}

} // namespace

Mesh simplified(const Mesh& mesh, double cell) {
    struct Vertex {
        std::uint32_t cell;
        Vec3d n{};
        Vec2d uv{};
        double count = 0;
    };
    struct Cell {
        Vec3d p{};
        double count = 0;
    };
    Box3 bounds;
    for (const Vec3 p : mesh.positions) bounds.extend(p);
    constexpr double kMostCells = 0x1p50; // along the diagonal; beyond, doubles do not tell cells from each other
    if (mesh.positions.empty() || !(length(Vec3d(bounds.high) - Vec3d(bounds.low)) < kMostCells * cell)) return mesh;
    Numbering number_of_cell, number_of_vertex;
    std::vector<Cell> cells;      // sums over the mesh's vertices
    std::vector<Vertex> vertices; // likewise
    std::vector<std::uint32_t> vertex_of(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3d p(mesh.positions[i]);
        const std::uint32_t c = number_of_cell(cell_key(p, Vec3d(bounds.low), cell));
        if (c == cells.size()) cells.emplace_back();
        cells[c].p = cells[c].p + p, ++cells[c].count;
        const std::uint32_t v = vertex_of[i] = number_of_vertex(vertex_key(mesh, i, c));
        if (v == vertices.size()) vertices.push_back({.cell = c});
        Vertex& vertex = vertices[v];
        if (!mesh.normals.empty()) vertex.n = vertex.n + Vec3d(mesh.normals[i]);
        if (!mesh.uvs.empty()) vertex.uv = vertex.uv + Vec2d(mesh.uvs[i]);
        ++vertex.count;
    }
    Mesh result;
    for (const Vertex& vertex : vertices) {
        const Cell& its = cells[vertex.cell];
        result.positions.push_back(Vec3(its.p * (1 / its.count)));
        if (!mesh.normals.empty()) result.normals.push_back(Vec3(normalize_or_zero(vertex.n)));
        if (!mesh.uvs.empty()) result.uvs.push_back(Vec2(vertex.uv * (1 / vertex.count)));
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        std::array<std::uint32_t, 3> corners, at;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = vertex_of[mesh.triangles[i][k]], at[k] = vertices[corners[k]].cell;
        if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
        result.triangles.push_back(corners);
        if (!mesh.material_slots.empty()) result.material_slots.push_back(mesh.material_slots[i]);
    }
    result.closed = is_closed_outwards(result);
    return result;
}

} // namespace duet::raster

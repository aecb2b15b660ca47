#include "models/implicit.h"

#include "common/system/error.h"

#include <bit>
#include <unordered_map>

namespace duet::models {
namespace {

/// A Lattice is a lattice point in units of half a cell. A cube's corner has even coordinates, and its center odd ones.
struct Lattice {
    std::int32_t x = 0, y = 0, z = 0;

    std::uint64_t key() const {
        const auto part = [](std::int32_t i) {
            return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) & 0x1fffff;
        };
        return part(x) << 42 | part(y) << 21 | part(z);
    }
    friend Lattice operator+(Lattice a, Lattice b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
};

Vec3d to_vec(Lattice a) { return Vec3d(a.x, a.y, a.z); }

/// Holds the value and the gradient at a point, estimated from four samples around it.
struct Differential {
    double value;
    Vec3d gradient;
};

Differential differential(const Implicit& surface, Vec3d p, double step) {
    // The samples are at the corners of a regular tetrahedron, which takes four evaluations instead of seven.
    constexpr Vec3d kCorners[4] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
    Differential result{0, {}};
    for (const Vec3d& corner : kCorners) {
        const double value = surface.value(p + corner * step);
        result.value += value / 4;
        result.gradient += corner * (value / (4 * step));
    }
    return result;
}

class Polygonizer {
public:
    Polygonizer(const Implicit& surface, double cell) : surface_(surface), half_(cell / 2) {
        const double extent = max_component(surface.high - surface.low) / cell;
        DUET_CHECK_LT(extent, 1 << 19); // leaves enough bits for the keys
        root_ = static_cast<std::int32_t>(std::bit_ceil(static_cast<std::uint32_t>(extent) + 1));
    }

    MeshBuilder run() {
        visit({0, 0, 0}, root_);
        return std::move(mesh_);
    }

private:
    Vec3d position(Lattice a) const { return surface_.low + to_vec(a) * half_; }

    /// Descends into the cube of `size` cells at `low`, unless the surface is farther from the cube than one cell.
    void visit(Lattice low, std::int32_t size) {
        const Lattice center{low.x + size, low.y + size, low.z + size};
        const double h = size / 2.0;
        // A tetrahedron on a cube's face extends into the neighboring cube, so the reach includes the neighbor's far
        // corners.
        const double reach = std::sqrt(sqr(h + 1) + 2 * sqr(h)) * 2 * half_;
        if (std::abs(surface_.value(position(center))) > surface_.steepness * reach) return;
        if (size == 1) return march_cube(low);
        for (int octant = 0; octant < 8; ++octant) {
            const std::int32_t s = size; // half the cube's size, in half cells
            visit({low.x + (octant & 1 ? s : 0), low.y + (octant & 2 ? s : 0), low.z + (octant & 4 ? s : 0)}, size / 2);
        }
    }

    /// Marches the tetrahedra on a cube's three upper faces. Each consists of two cubes' centers and one edge of the
    /// face between them.
    void march_cube(Lattice low) {
        const Lattice center = low + Lattice{1, 1, 1};
        constexpr Lattice kAxes[3] = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Lattice a = kAxes[(axis + 1) % 3], b = kAxes[(axis + 2) % 3];
            const Lattice corner = low + kAxes[axis], other = center + kAxes[axis];
            const Lattice loop[4] = {corner, corner + a, corner + a + b, corner + b};
            for (std::size_t i = 0; i < 4; ++i) march_tetrahedron({center, other, loop[i], loop[(i + 1) % 4]});
        }
    }

    void march_tetrahedron(const std::array<Lattice, 4>& tetrahedron) {
        std::array<Lattice, 4> inside, outside;
        std::size_t ins = 0, outs = 0;
        for (const Lattice& corner : tetrahedron) (value(corner) < 0 ? inside[ins++] : outside[outs++]) = corner;
        if (ins == 0 || outs == 0) return;
        if (ins == 1)
            add_polygon({{inside[0], outside[0]}, {inside[0], outside[1]}, {inside[0], outside[2]}});
        else if (outs == 1)
            add_polygon({{inside[0], outside[0]}, {inside[1], outside[0]}, {inside[2], outside[0]}});
        else
            add_polygon(
                {{inside[0], outside[0]}, {inside[0], outside[1]}, {inside[1], outside[1]}, {inside[1], outside[0]}});
    }

    struct Edge {
        Lattice inside, outside;
    };

    /// Adds a triangle or a quad between the crossings of lattice edges, oriented outward. The orientation is
    /// determined at the edges' midpoints, where it is exact.
    void add_polygon(std::vector<Edge> edges) {
        std::array<Vec3d, 3> middle;
        for (std::size_t i = 0; i < 3; ++i) middle[i] = to_vec(edges[i].inside + edges[i].outside);
        const Vec3d outwards = to_vec(edges[0].outside) - to_vec(edges[0].inside);
        if (dot(cross(middle[1] - middle[0], middle[2] - middle[0]), outwards) < 0) std::swap(edges[0], edges[2]);
        std::vector<std::uint32_t> ids;
        for (const Edge& edge : edges) ids.push_back(crossing(edge));
        for (std::size_t i = 2; i < ids.size(); ++i) {
            const auto corner = [](std::uint32_t id) { return MeshBuilder::Corner{id, 0, id}; };
            mesh_.triangles.push_back({corner(ids[0]), corner(ids[i - 1]), corner(ids[i])});
        }
    }

    double value(Lattice a) {
        const auto [found, is_new] = values_.try_emplace(a.key(), 0.0);
        if (is_new) found->second = surface_.value(position(a));
        return found->second;
    }

    /// Returns the vertex where the surface crosses a lattice edge. It stays away from the edge's ends, so that no
    /// vertices coincide.
    std::uint32_t crossing(const Edge& edge) {
        const double in = value(edge.inside), out = value(edge.outside);
        const auto [found, is_new] = crossings_.try_emplace({edge.inside.key(), edge.outside.key()}, 0u);
        if (is_new) {
            found->second = static_cast<std::uint32_t>(mesh_.positions.size());
            const double t = clamp(in / (in - out), 0.05, 0.95);
            mesh_.positions.push_back(lerp(position(edge.inside), position(edge.outside), t));
        }
        return found->second;
    }

    using EdgeKey = std::pair<std::uint64_t, std::uint64_t>;
    struct EdgeHash {
        std::size_t operator()(const EdgeKey& k) const {
            return (k.first * 0x9e3779b97f4a7c15u) ^ (k.second * 0xc2b2ae3d27d4eb4fu);
        }
    };

    const Implicit& surface_;
    double half_;
    std::int32_t root_;
    MeshBuilder mesh_;
    std::unordered_map<std::uint64_t, double> values_;
    std::unordered_map<EdgeKey, std::uint32_t, EdgeHash> crossings_;
};

/// Returns the area-weighted sum of the normals of the triangles around each vertex.
std::vector<Vec3d> area_normals(const MeshBuilder& mesh) {
    std::vector<Vec3d> sum(mesh.positions.size());
    for (const auto& t : mesh.triangles) {
        const Vec3d a = mesh.positions[t[0].position];
        const Vec3d normal = cross(mesh.positions[t[1].position] - a, mesh.positions[t[2].position] - a);
        for (const auto& corner : t) sum[corner.position] += normal;
    }
    return sum;
}

/// Moves each vertex along the surface halfway to the mean of its neighbors, and then back onto the surface.
void relax(MeshBuilder& mesh, const Implicit& surface, double cell) {
    std::vector<Vec3d> sum(mesh.positions.size());
    std::vector<double> count(mesh.positions.size());
    for (const auto& triangle : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            sum[triangle[k].position] += mesh.positions[triangle[(k + 1) % 3].position];
            count[triangle[k].position] += 1; // each neighbor follows in exactly one triangle
        }
    }
    const std::vector<Vec3d> normals = area_normals(mesh);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        Vec3d p = mesh.positions[i];
        const Vec3d move = (sum[i] / count[i] - p) * 0.5, normal = normals[i];
        p += move - normal * (dot(move, normal) / max(length_squared(normal), 1e-300));
        const Differential d = differential(surface, p, 0.1 * cell);
        const Vec3d step = d.gradient * (d.value / max(length_squared(d.gradient), 0.25)); // Newton's method
        const double limit = 0.25 * cell, size = length(step);
        mesh.positions[i] = p - (size > limit ? step * (limit / size) : step);
    }
}

/// Sets gradients as normals. Where a gradient contradicts a triangle (at a crease finer than the lattice), the
/// triangles' normals are used.
void set_normals(MeshBuilder& mesh, const Implicit& surface, double cell) {
    const std::vector<Vec3d> faces = area_normals(mesh);
    mesh.normals.clear();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3d gradient = differential(surface, mesh.positions[i], 0.15 * cell).gradient;
        const bool agree = dot(gradient, faces[i]) > 0.5 * length(gradient) * length(faces[i]);
        mesh.normals.push_back(normalize(agree ? gradient : faces[i]));
    }
}

} // namespace

MeshBuilder polygonize(const Implicit& surface, double cell) {
    MeshBuilder mesh = Polygonizer(surface, cell).run();
    for (int pass = 0; pass < 4; ++pass) relax(mesh, surface, cell);
    set_normals(mesh, surface, cell);
    return mesh;
}

} // namespace duet::models

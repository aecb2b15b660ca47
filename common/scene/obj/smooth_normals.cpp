#include "common/scene/obj/smooth_normals.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <unordered_map>

namespace duet {

namespace {

using Index = std::uint32_t;

/// Returns an index for each vertex such that equal positions have equal indices.
std::vector<Index> weld(const std::vector<Vec3>& positions) {
    std::vector<Index> order(positions.size()), welded(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto less = [&](Index a, Index b) {
        const Vec3 &p = positions[a], &q = positions[b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    std::sort(order.begin(), order.end(), less);
    for (std::size_t i = 0; i < order.size(); ++i)
        welded[order[i]] = i > 0 && positions[order[i]] == positions[order[i - 1]] ? welded[order[i - 1]] : order[i];
    return welded;
}

/// CornerSets is a union-find structure over triangle corners (3·triangle + k). Corners of one set share a normal.
class CornerSets {
public:
    explicit CornerSets(std::size_t corners) : parent_(corners) { std::iota(parent_.begin(), parent_.end(), 0u); }
    Index find(Index i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(Index a, Index b) {
        const Index x = find(a), y = find(b);
        parent_[std::max(x, y)] = std::min(x, y);
    }

private:
    std::vector<Index> parent_;
};

Vec3d unit_or_zero(Vec3d v) {
    const double size = length(v);
    return size > 0 ? v / size : Vec3d();
}

struct Edge {
    Index low, high; ///< welded indices of the edge's ends
    Index corner;    ///< corner of the triangle at which the edge begins
    bool forward;    ///< whether the triangle's winding runs from low to high
};

class Smoother {
public:
    explicit Smoother(const Mesh& mesh) : mesh_(mesh), welded_(weld(mesh.positions)), sets_(3 * mesh.triangles.size()) {
        normals_.reserve(mesh.triangles.size());
        for (const auto& t : mesh.triangles) {
            const Vec3d a(mesh.positions[t[0]]);
            normals_.push_back(unit_or_zero(cross(Vec3d(mesh.positions[t[1]]) - a, Vec3d(mesh.positions[t[2]]) - a)));
        }
        join_over_edges();
    }

    /// Returns one normal for each corner set, at the index of the set's first corner.
    std::vector<Vec3d> normals() {
        std::vector<Vec3d> sums(3 * mesh_.triangles.size());
        for (Index t = 0; t < mesh_.triangles.size(); ++t)
            for (Index k = 0; k < 3; ++k) sums[sets_.find(3 * t + k)] += normals_[t] * angle(t, k);
        return sums;
    }
    Index set_of(Index corner) { return sets_.find(corner); }

private:
    Vec3d position(Index triangle, Index k) const { return Vec3d(mesh_.positions[mesh_.triangles[triangle][k % 3]]); }

    double angle(Index t, Index k) const {
        const Vec3d p = position(t, k), u = position(t, k + 1) - p, v = position(t, k + 2) - p;
        return std::atan2(length(cross(u, v)), dot(u, v)); // accurate for needle triangles too
    }

    void join_over_edges() {
        std::vector<Edge> edges;
        edges.reserve(3 * mesh_.triangles.size());
        for (Index t = 0; t < mesh_.triangles.size(); ++t)
            for (Index k = 0; k < 3; ++k) {
                const Index a = welded_[mesh_.triangles[t][k]], b = welded_[mesh_.triangles[t][(k + 1) % 3]];
                if (a != b) edges.push_back({std::min(a, b), std::max(a, b), 3 * t + k, a < b});
            }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
            return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.corner < b.corner;
        });
        for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
            for (end = i + 1; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high;)
                ++end;
            // Corners are only joined where exactly two triangles share the edge with consistent winding, because
            // only there is one surface to smooth.
            if (end - i == 2 && edges[i].forward != edges[i + 1].forward) join_if_smooth(edges[i], edges[i + 1]);
        }
    }

    void join_if_smooth(const Edge& a, const Edge& b) {
        static const double least = std::cos(radians(kCreaseDegrees));
        if (!(dot(normals_[a.corner / 3], normals_[b.corner / 3]) >= least)) return;
        const auto next = [](Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
        sets_.join(a.corner, next(b.corner)); // the triangles traverse the edge in opposite directions
        sets_.join(next(a.corner), b.corner);
    }

    const Mesh& mesh_;
    std::vector<Index> welded_;
    std::vector<Vec3d> normals_; ///< normals of the triangles, unit or zero
    CornerSets sets_;
};

} // namespace

void add_smooth_normals(Mesh& mesh) {
    Smoother smoother(mesh);
    const std::vector<Vec3d> normals = smoother.normals();
    const std::size_t vertices = mesh.positions.size();
    constexpr Index kNone = ~0u;
    std::vector<Index> first_set(vertices, kNone);    // set of each vertex's normal
    std::unordered_map<std::uint64_t, Index> duplicates; // maps (vertex, set) to the new vertex on a crease
    mesh.normals.assign(vertices, Vec3(0, 1, 0));
    const auto set_normal = [&](Index vertex, Index set) {
        const Vec3d n = unit_or_zero(normals[set]);
        mesh.normals[vertex] = n == Vec3d() ? Vec3(0, 1, 0) : Vec3(n);
    };
    for (Index t = 0; t < mesh.triangles.size(); ++t)
        for (Index k = 0; k < 3; ++k) {
            Index& vertex = mesh.triangles[t][k];
            const Index set = smoother.set_of(3 * t + k);
            if (first_set[vertex] == kNone) {
                first_set[vertex] = set;
                set_normal(vertex, set);
            } else if (first_set[vertex] != set) {
                const auto [entry, added] = duplicates.try_emplace((static_cast<std::uint64_t>(vertex) << 32) | set,
                                                                   static_cast<Index>(mesh.positions.size()));
                if (added) {
                    mesh.positions.push_back(Vec3(mesh.positions[vertex]));
                    if (!mesh.uvs.empty()) mesh.uvs.push_back(Vec2(mesh.uvs[vertex]));
                    mesh.normals.emplace_back();
                    set_normal(entry->second, set);
                }
                vertex = entry->second;
            }
        }
}

} // namespace duet

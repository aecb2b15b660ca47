#include "common/scene/obj/smooth_normals.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace duet {

namespace {

using Index = std::uint32_t;

/// CornerSets is a union-find structure over triangle corners (3·triangle + k). Corners of one set share a normal.
class CornerSets {
public:
    explicit CornerSets(std::size_t corners) : parent_(corners) { std::iota(parent_.begin(), parent_.end(), 0u); }
    void join(Index a, Index b) {
        const Index x = find(a), y = find(b);
        parent_[std::max(x, y)] = std::min(x, y);
    }
    /// Numbers the sets from 0 in the order of their first corners, and returns how many there are. Afterwards no sets
    /// can be joined. A parent is numbered before its corners, because it is the smaller index.
    std::size_t number_sets() {
        Index sets = 0;
        for (Index i = 0; i < parent_.size(); ++i) parent_[i] = parent_[i] == i ? sets++ : parent_[parent_[i]];
        return sets;
    }
    Index number(Index corner) const { return parent_[corner]; }

private:
    Index find(Index i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    std::vector<Index> parent_;
};

/// An Edge is listed at the end that has the lower welded index.
struct Edge {
    Index high;   ///< welded index of the edge's other end
    Index corner; ///< corner of the triangle at which the edge begins
};

Index next_corner(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

class Smoother {
public:
    explicit Smoother(const Mesh& mesh) : mesh_(mesh), welded_(weld(mesh.positions)), sets_(3 * mesh.triangles.size()) {
        normals_.reserve(mesh.triangles.size());
        for (const auto& t : mesh.triangles) {
            const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
            normals_.push_back(normalize_or_zero(cross(b - a, c - a)));
        }
        join_over_edges();
    }

    /// Returns one normal for each set of corners, by the set's number.
    std::vector<Vec3d> normals() {
        std::vector<Vec3d> sums(sets_.number_sets());
        for (Index t = 0; t < mesh_.triangles.size(); ++t)
            for (Index k = 0; k < 3; ++k) sums[sets_.number(3 * t + k)] += normals_[t] * angle(t, k);
        return sums;
    }
    /// Returns the number of the corner's set, once normals() has numbered them.
    Index set_of(Index corner) const { return sets_.number(corner); }

private:
    Vec3d position(Index triangle, Index k) const { return Vec3d(mesh_.positions[mesh_.triangles[triangle][k % 3]]); }
    Index welded(Index corner) const { return welded_[mesh_.triangles[corner / 3][corner % 3]]; }

    double angle(Index t, Index k) const {
        const Vec3d p = position(t, k), u = position(t, k + 1) - p, v = position(t, k + 2) - p;
        return std::atan2(length(cross(u, v)), dot(u, v)); // accurate for needle triangles too
    }

    void join_over_edges() {
        // The edges are sorted by their lower end by counting, which takes half the time of comparing.
        const Index corners = static_cast<Index>(3 * mesh_.triangles.size());
        std::vector<Index> ends(mesh_.positions.size() + 1);
        const auto for_each_edge = [&](const auto& visit) {
            for (Index corner = 0; corner < corners; ++corner) {
                const Index a = welded(corner), b = welded(next_corner(corner));
                if (a != b) visit(std::min(a, b), Edge{std::max(a, b), corner});
            }
        };
        for_each_edge([&](Index low, const Edge&) { ++ends[low + 1]; });
        std::partial_sum(ends.begin(), ends.end(), ends.begin());
        std::vector<Edge> edges(ends.back());
        for_each_edge([&](Index low, const Edge& edge) { edges[ends[low]++] = edge; });
        for (std::size_t low = 0, begin = 0; low < mesh_.positions.size(); begin = ends[low++])
            join_edges(edges.data() + begin, edges.data() + ends[low]);
    }

    /// Joins corners over the edges of one lower end.
    void join_edges(Edge* begin, Edge* end) {
        std::sort(begin, end, [](const Edge& a, const Edge& b) {
            return a.high != b.high ? a.high < b.high : a.corner < b.corner;
        });
        for (const Edge *first = begin, *last = begin; first != end; first = last) {
            while (last != end && last->high == first->high) ++last;
            // Corners are only joined where exactly two triangles share the edge with consistent winding, because
            // only there is one surface to smooth. Consistent triangles traverse the edge in opposite directions.
            if (last - first == 2 && welded(first[0].corner) != welded(first[1].corner))
                join_if_smooth(first[0].corner, first[1].corner);
        }
    }

    /// Joins the corners at both ends of an edge that begins at corner a of one triangle and at corner b of the other.
    void join_if_smooth(Index a, Index b) {
        static const double least = std::cos(radians(kCreaseDegrees));
        if (!(dot(normals_[a / 3], normals_[b / 3]) >= least)) return;
        sets_.join(a, next_corner(b));
        sets_.join(next_corner(a), b);
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
        const Vec3d n = normalize_or_zero(normals[set]);
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

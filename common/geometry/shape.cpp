#include "common/geometry/shape.h"

#include "common/vec/robust.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace duet {

std::uint32_t primitive_count(const Shape& shape) {
    if (const auto* mesh = std::get_if<Mesh>(&shape)) return static_cast<std::uint32_t>(mesh->triangles.size());
    if (const auto* list = std::get_if<QuadList>(&shape)) return static_cast<std::uint32_t>(list->quads.size());
    return 1;
}

namespace {

// Returns the bounds of a sphere under an affine map. The half extent of the resulting ellipsoid along an axis is r
// times the length of the matrix row (Sigg et al. 2006, eq. 4, in affine form).
Box3d sphere_bounds(const Sphere& sphere, const Mat4d& m) {
    const Vec3d center = transform_point(m, Vec3d(sphere.center));
    Vec3d extent;
    for (std::size_t axis = 0; axis < 3; ++axis)
        extent[axis] = static_cast<double>(sphere.radius) * length(Vec3d(m[axis][0], m[axis][1], m[axis][2]));
    return {center - extent, center + extent};
}

// Rounds a box outward to float. The box is enlarged by the rounding error of points that are transformed in float.
Box3 rounded_outward(const Box3d& box) {
    Box3 result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double magnitude = std::max(std::abs(box.low[axis]), std::abs(box.high[axis]));
        const double margin = magnitude * static_cast<double>(gamma_bound(4));
        result.low[axis] = next_down(static_cast<float>(box.low[axis] - margin));
        result.high[axis] = next_up(static_cast<float>(box.high[axis] + margin));
    }
    return result;
}

} // namespace

Box3 bounds(const Shape& shape, const Mat4& transform) {
    const Mat4d m(transform);
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return rounded_outward(sphere_bounds(*sphere, m));
    Box3d box;
    const auto extend = [&](Vec3 p) { box.extend(transform_point(m, Vec3d(p))); };
    if (const auto* mesh = std::get_if<Mesh>(&shape))
        std::for_each(mesh->positions.begin(), mesh->positions.end(), extend);
    else
        for (const Quad& quad : std::get<QuadList>(shape).quads)
            for (const Vec3& p : corners(quad)) extend(p);
    return rounded_outward(box);
}

QuadList box_quads(Vec3 low, Vec3 high) {
    const Vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
    const Vec3 far(low.x + x.x, low.y + y.y, low.z + z.z); // the same rounded sums as in corners()
    return {{
        {low, z, y},                   // −x
        {{far.x, low.y, low.z}, y, z}, // +x
        {low, x, z},                   // −y
        {{low.x, far.y, low.z}, z, x}, // +y
        {low, y, x},                   // −z
        {{low.x, low.y, far.z}, x, y}, // +z
    }};
}

std::vector<std::uint32_t> weld(const std::vector<Vec3>& positions) {
    std::vector<std::uint32_t> order(positions.size()), welded(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
        const Vec3 &p = positions[a], &q = positions[b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    std::sort(order.begin(), order.end(), less);
    for (std::size_t i = 0; i < order.size(); ++i)
        welded[order[i]] = i > 0 && positions[order[i]] == positions[order[i - 1]] ? welded[order[i - 1]] : order[i];
    return welded;
}

bool is_closed_outwards(const Mesh& mesh) {
    if (mesh.triangles.empty()) return false;
    // A seam in the uvs or normals does not open a mesh.
    const std::vector<std::uint32_t> welded = weld(mesh.positions);
    // Each connected component must enclose a positive volume. A component with reversed orientation would show its
    // back faces to the outside. The components are found by union-find over the edges.
    std::vector<std::uint32_t> parent = welded;
    const auto component = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::vector<std::uint32_t> first(mesh.positions.size() + 1); // index in `ends` of each vertex's first edge
    const auto for_edges = [&](const auto& visit) {
        for (const auto& t : mesh.triangles)
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t from = welded[t[i]], to = welded[t[(i + 1) % 3]];
                if (from != to) visit(from, to);
            }
    };
    for_edges([&](std::uint32_t from, std::uint32_t to) {
        ++first[from + 1];
        parent[component(from)] = component(to);
    });
    // The divergence theorem gives six times the volume of each component.
    std::vector<double> volume(mesh.positions.size(), 0.0);
    for (const auto& t : mesh.triangles) {
        const std::uint32_t root = component(welded[t[0]]);
        // Coordinates relative to a vertex of the component avoid cancellation far from the world's origin.
        const Vec3d origin(mesh.positions[root]);
        const auto corner = [&](std::size_t i) { return Vec3d(mesh.positions[t[i]]) - origin; };
        volume[root] += dot(corner(0), cross(corner(1), corner(2)));
    }
    // The edges are sorted by the vertex that they leave, with a counting sort, and then by the vertex that they reach.
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> ends(first.back()), next = first;
    for_edges([&](std::uint32_t from, std::uint32_t to) { ends[next[from]++] = to; });
    const auto ends_of = [&](std::uint32_t from) {
        return std::span(ends).subspan(first[from], first[from + 1] - first[from]);
    };
    for (std::uint32_t from = 0; from < mesh.positions.size(); ++from) {
        const std::span<std::uint32_t> reached = ends_of(from);
        if (!reached.empty() && !(volume[component(from)] > 0)) return false;
        std::sort(reached.begin(), reached.end());
        if (std::adjacent_find(reached.begin(), reached.end()) != reached.end()) return false; // the same edge twice
    }
    for (std::uint32_t from = 0; from < mesh.positions.size(); ++from)
        for (const std::uint32_t to : ends_of(from))
            if (!std::ranges::binary_search(ends_of(to), from)) return false;
    return true;
}

} // namespace duet

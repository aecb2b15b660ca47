// This header represents primitives by their vertices, as the BVH builders take them.
#pragma once

#include "raytrace/acceleration/bvh_build.h"
#include "raytrace/acceleration/bvh_hierarchy.h"
#include "tests/raytrace/acceleration/soup.h"

#include <array>
#include <cstring>
#include <vector>

namespace duet::raytrace {

/// Holds the corners of a triangle or a quad, in order.
struct ConvexPolygon {
    std::array<Vec3, 4> corners;
    std::size_t count = 0;
};

struct PolygonItems {
    std::vector<ConvexPolygon> polygons;
    BuildItems items;

    void add(const ConvexPolygon& polygon, PrimitiveKind kind = PrimitiveKind::kTriangle) {
        Box3 box;
        for (std::size_t i = 0; i < polygon.count; ++i) box.extend(polygon.corners[i]);
        items.push_back({box, static_cast<std::uint32_t>(polygons.size()), kind});
        polygons.push_back(polygon);
    }
    explicit PolygonItems(const Mesh& mesh) {
        for (const auto& [a, b, c] : mesh.triangles)
            add({{mesh.positions[a], mesh.positions[b], mesh.positions[c]}, 3});
    }
    PolygonItems() = default;
};

inline bool same_trees(const BinaryTree& a, const BinaryTree& b) {
    if (a.nodes.size() != b.nodes.size() || a.items.size() != b.items.size()) return false;
    for (std::size_t i = 0; i < a.nodes.size(); ++i)
        if (std::memcmp(&a.nodes[i], &b.nodes[i], sizeof(BinaryNode)) != 0) return false;
    for (std::size_t i = 0; i < a.items.size(); ++i)
        if (a.items[i].index != b.items[i].index) return false;
    return true;
}

} // namespace duet::raytrace

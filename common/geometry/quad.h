// This file declares the intersection of a ray and a quad.
#pragma once

#include "common/geometry/shape.h"
#include "common/geometry/triangle.h"

namespace duet {

/// Intersects a ray with the quad of the given corners. Returns t and the coordinates u, v in [0, 1] along the two
/// edges of the quad, or nothing on a miss. The quad is tested as the two triangles 0, 1, 2 and 0, 2, 3, and is
/// therefore watertight along edges that it shares with quads and triangles of the same vertices.
std::optional<TriangleHit> intersect_quad(const ShearedRay& ray, const std::array<Vec3, 4>& corners);
inline std::optional<TriangleHit> intersect_quad(const ShearedRay& ray, const Quad& quad) {
    return intersect_quad(ray, corners(quad));
}

} // namespace duet

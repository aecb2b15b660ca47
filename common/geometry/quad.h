// Ray and quad.
#pragma once

#include "common/geometry/shape.h"
#include "common/geometry/triangle.h"

namespace duet {

/// Where the ray meets the quad of these corners: t, and the coordinates u, v in [0, 1] along its two edges. Watertight
/// along edges it shares with other quads and triangles of the same vertices: tested as the two triangles 0, 1, 2 and
/// 0, 2, 3.
std::optional<TriangleHit> intersect_quad(const ShearedRay& ray, const std::array<Vec3, 4>& corners);
inline std::optional<TriangleHit> intersect_quad(const ShearedRay& ray, const Quad& quad) {
    return intersect_quad(ray, corners(quad));
}

} // namespace duet

// Ray and quad.
#pragma once

#include "common/geometry/shape.h"
#include "common/geometry/triangle.h"

namespace duet {

/// Where the ray meets the quad: t, and the coordinates u, v in [0, 1] along its two edges. Watertight along edges it
/// shares with other quads and triangles of the same vertices: tested as the two triangles of its corners.
std::optional<TriangleHit> intersect_quad(const ShearedRay& ray, const Quad& quad);

} // namespace duet

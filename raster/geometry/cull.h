// Implements stage 2, which culls invisible primitives, whole objects first.
#pragma once

#include "raster/geometry/transform.h"

#include "common/vec/box.h"

#include <cstdint>

namespace duet::raster {

/// Counts the culled primitives by reason. A quad counts as the two triangles it is drawn as.
struct CullCounts {
    std::int64_t backfaces = 0, outside = 0, subpixel = 0, degenerate = 0;

    CullCounts& operator+=(const CullCounts& other);
};

/// Returns true if a world-space box lies entirely beyond one plane of the view frustum, or is empty.
bool outside_frustum(const Box3& box, const Pinhole& pinhole, const Viewport& viewport);

/// Returns true if an object's back faces may be culled: it is opaque, closed and oriented outwards (`solid`), and
/// all of it lies beyond the near plane. Then the eye (or the origin of an orthographic ray) is not inside, and a
/// front face covers every sample that a back face covers. The snapped mesh is as closed as the mesh, so equally
/// many front and back faces cover a sample.
bool may_cull_backfaces(const TransformedObject& object, bool solid);

/// Returns twice the signed area of a triangle on the grid, in grid units; exact. It is positive if the corners run
/// clockwise in the image (y points down).
std::int64_t doubled_area(FixedPoint a, FixedPoint b, FixedPoint c);

/// Returns true if a triangle with this doubled area is back-facing. A front face is counter-clockwise in an object
/// that is not mirrored.
inline bool is_backface(std::int64_t area, bool mirrored) { return (area > 0) != mirrored; }

} // namespace duet::raster

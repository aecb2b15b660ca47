// Stage 2: what can't be seen is left out, whole objects first.
#pragma once

#include "raster/geometry/transform.h"

#include "common/vec/box.h"

#include <cstdint>

namespace duet::raster {

/// How many primitives were left out, and why. A quad counts as the two triangles it is drawn as.
struct CullCounts {
    std::int64_t backfaces = 0, outside = 0, subpixel = 0, degenerate = 0;

    CullCounts& operator+=(const CullCounts& other);
};

/// Whether all of a world box lies beyond one plane of the view's frustum. Empty boxes do.
bool outside_frustum(const Box3& box, const Pinhole& pinhole, const Viewport& viewport);

/// Whether an object's back faces may go: it is opaque, closed and oriented outwards (`solid`), and all of it lies
/// beyond the near plane. Then the eye, or an orthographic ray's start, is not inside, and whatever sample a back face
/// covers, a front face covers too: the snapped mesh is as closed as the mesh, so fronts and backs over a sample are
/// equally many.
bool may_cull_backfaces(const TransformedObject& object, bool solid);

/// Twice the signed area of a triangle of the grid, in units of the grid; exact. Positive where it runs clockwise as
/// seen in the picture (y points down).
std::int64_t doubled_area(FixedPoint a, FixedPoint b, FixedPoint c);

/// Whether a triangle with that area shows its back. Front is counter-clockwise, in an object that is not mirrored.
inline bool is_backface(std::int64_t area, bool mirrored) { return (area > 0) != mirrored; }

} // namespace duet::raster

// This file computes vertex normals for meshes without any.
#pragma once

#include "common/geometry/shape.h"

namespace duet {

/// Edges whose triangles' normals differ by more than this angle stay sharp.
inline constexpr double kCreaseDegrees = 60;

/// Computes smooth vertex normals for the mesh. Around each point, the triangles that are connected by edges of at
/// most kCreaseDegrees share one normal: the mean of their normals, weighted by each triangle's angle at the point
/// (Thürmer and Wüthrich 1998). Vertices are merged by position, so that texture seams remain smooth. Vertices on a
/// crease are duplicated. The normal is (0, 1, 0) where only triangles without area meet.
void add_smooth_normals(Mesh& mesh);

} // namespace duet

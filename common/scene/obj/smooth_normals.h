// Vertex normals for meshes that come without.
#pragma once

#include "common/geometry/shape.h"

namespace duet {

/// Edges at which the surface bends by more than this stay sharp.
inline constexpr double kCreaseDegrees = 60;

/// Gives the mesh smooth normals: around each point the triangles that hang together by edges bent by at most
/// kCreaseDegrees share one normal, the mean of theirs weighted by the angle each has there (Thürmer and Wüthrich
/// 1998). Vertices are taken together by position, so seams of the texture don't show; vertices on a crease are
/// doubled. Triangles without area get (0, 1, 0) where nothing else says better.
void add_smooth_normals(Mesh& mesh);

} // namespace duet

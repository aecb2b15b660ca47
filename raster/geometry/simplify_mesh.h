// This header declares the simplification of meshes by vertex clustering (Rossignac and Borrel 1993, "Multi-resolution
// 3D Approximations for Rendering Complex Scenes").
#pragma once

#include "common/geometry/shape.h"

namespace duet::raster {

/// Returns a mesh in which all vertices of a cube of side `cell`, ≥ 0 and in the mesh's units, lie at their mean
/// position; the same mesh if `cell` is too small for the precision of numbers. Triangles that collapse to a line or a
/// point are left out. Vertices of one cube stay apart if their normals differ much or they lie far from each other in
/// the texture. The result has gaps only where the mesh has some.
Mesh simplified(const Mesh& mesh, double cell);

} // namespace duet::raster

// This header declares implicit surfaces and the meshes that approximate them.
#pragma once

#include "models/mesh_builder.h"

namespace duet::models {

/// An Implicit is the surface value = 0, where negative values are inside. The surface lies entirely between low and
/// high.
struct Implicit {
    std::function<double(Vec3d)> value;
    Vec3d low, high;
    double steepness = 1.5; ///< bounds |∇value|, so that empty space can be skipped
};

/// Returns a closed, manifold mesh of the surface with its gradients as normals. It uses marching tetrahedra on the
/// body-centered cubic lattice of side `cell`. The tetrahedra are congruent and nearly regular (Labelle and Shewchuk
/// 2007, "Isosurface Stuffing", §3). No case is ambiguous, and each edge is shared by exactly two triangles. Finally
/// the vertices are spread evenly along the surface.
MeshBuilder polygonize(const Implicit& surface, double cell);

} // namespace duet::models

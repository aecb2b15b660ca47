// Surfaces given by a function, and the meshes that approximate them.
#pragma once

#include "models/mesh_builder.h"

namespace duet::models {

/// The surface value = 0, negative inside; it lies wholly between low and high.
struct Implicit {
    std::function<double(Vec3d)> value;
    Vec3d low, high;
    double steepness = 1.5; ///< bounds |∇value|: what lets empty space be skipped
};

/// A closed, manifold mesh of the surface with its gradients as normals. Marching tetrahedra on the body-centred cubic
/// lattice of side `cell` (its tetrahedra are all alike and nearly regular: Labelle and Shewchuk 2007, «Isosurface
/// Stuffing», §3): no case is ambiguous, each triangle's edge has exactly one other. Then vertices are spread evenly
/// along the surface.
MeshBuilder polygonize(const Implicit& surface, double cell);

} // namespace duet::models

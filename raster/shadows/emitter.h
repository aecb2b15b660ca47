// This header declares the approximate shape of an area light that shadows are computed for.
#pragma once

#include "common/light/light.h"

#include <span>

namespace duet::raster {

/// Approximates a light's shape by a parallelogram, a triangle, or a sphere. A receiver sees the sphere as a disk
/// facing it.
struct Emitter {
    enum class Kind { kParallelogram, kTriangle, kSphere };
    Kind kind = Kind::kSphere;
    Vec3d center; ///< the shadow maps are rendered from this point
    Vec3d u, v; ///< edges; unused for a sphere
    Vec3d normal; ///< unit normal on the emitting side; unused for a sphere
    double radius = 0;

    /// Returns the shape of one surface light.
    static Emitter of(const SurfaceLight& light);
    /// Returns the shape of one light, or of a group of triangles and quads. For a coplanar group that faces one way
    /// this is the smallest bounding rectangle along an edge of the first light. Otherwise it is a bounding sphere.
    static Emitter of(std::span<const SurfaceLight> lights);
};

} // namespace duet::raster

// This header declares the shape of an area light as shadows approximate it.
#pragma once

#include "common/light/light.h"

#include <span>

namespace duet::raster {

/// Shadows approximate a light's shape by a parallelogram, a triangle, or a sphere. A receiver sees the sphere as a
/// disk facing it.
struct Emitter {
    enum class Kind { kParallelogram, kTriangle, kSphere };
    Kind kind = Kind::kSphere;
    Vec3d center; ///< the point from which its shadow maps are rendered
    Vec3d u, v; ///< edges; unused for a sphere
    Vec3d normal; ///< of its plane, on the emitting side; unused for a sphere
    double radius = 0;

    /// Returns the shape of one surface light.
    static Emitter of(const SurfaceLight& light);
    /// Returns the shape of one light, or of a group of triangles and quads. For a coplanar group that faces one way
    /// this is the smallest bounding rectangle along an edge of the first light. Otherwise it is a bounding sphere.
    static Emitter of(std::span<const SurfaceLight> lights);
};

} // namespace duet::raster

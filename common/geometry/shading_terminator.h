// This file computes the smooth surface that the vertex normals of a flat triangle represent. It fixes the shading
// terminator: without it, smooth-shaded triangles near the terminator cast stepped shadows on each other.
#pragma once

#include "common/vec/vec.h"

#include <array>

namespace duet {

/// Returns the vector from a point p of a triangle to the smooth surface, on the side from which a ray of the given
/// direction arrives. The smooth point is the weighted mean of the projections of p onto the tangent planes of the
/// vertices (Hanika 2021; Boubekeur and Alexa 2008, "Phong Tessellation").
///
/// The result is zero unless the surface is convex toward the viewer, that is, unless p lies below all three tangent
/// planes. As a tolerance, p may lie above a plane by up to a tenth of its largest depth below another plane. The
/// result is thus zero for flat, concave and saddle-shaped surfaces, and where all vertex normals only tilt in one
/// direction.
///
/// `normals` are the unit vertex normals, `weights` are the barycentric coordinates of p, and `ng` is the geometric
/// normal of the triangle. `ng` and the direction may have any length. T is double or a batch of doubles.
template <typename T>
Vec3T<T> shading_terminator_offset(const Vec3T<T>& p, const std::array<Vec3T<T>, 3>& vertices,
                                   const std::array<Vec3T<T>, 3>& normals, const std::array<T, 3>& weights,
                                   const Vec3T<T>& ng, const Vec3T<T>& direction) {
    const T zero(0.0), side = select(dot(ng, direction) > zero, T(-1.0), T(1.0));
    Vec3T<T> offset(zero, zero, zero);
    T max_below = zero, min_below = zero;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3T<T> n = normals[i] * select(dot(normals[i], ng) < zero, -side, side);
        const T below = dot(vertices[i] - p, n);
        max_below = max(max_below, below);
        min_below = min(min_below, below);
        offset = select(below > zero, offset + n * (below * weights[i]), offset);
    }
    return select(min_below < T(-0.1) * max_below, Vec3T<T>(zero, zero, zero), offset);
}

} // namespace duet

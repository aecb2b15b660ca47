// This file computes the smooth surface that the vertex normals of a flat triangle represent. Rays that start there fix
// the shading terminator: otherwise, smooth-shaded triangles near the terminator cast stepped shadows on each other.
#pragma once

#include "common/vec/vec.h"

#include <array>

namespace duet {

/// Returns the vector from a point of a triangle to the smooth surface, on the side from which a ray of the given
/// direction arrives (Hanika 2021, "Hacking the Shadow Terminator"). Phong tessellation moves the point p along the
/// normals nᵢ of the vertices vᵢ, with barycentric weights wᵢ, by Σ wᵢ nᵢ·(vᵢ − p) (Boubekeur and Alexa 2008). That is
/// a sum over the three edges, Σ wᵢ wⱼ (nᵢ − nⱼ)·(vᵢ − vⱼ), in which each edge that is convex toward the viewer is
/// positive. Only these count here, so the smooth surface is nowhere below the triangle, and has no gaps at its edges.
///
/// The result is zero for flat and concave surfaces, and where all vertex normals only tilt in one direction.
/// `normals` are the unit vertex normals, `weights` are the barycentric coordinates of p, `ns` is the interpolated and
/// `ng` the geometric normal. `ns`, `ng` and the direction may have any length. T is double or a batch of doubles.
template <typename T>
Vec3T<T> shading_terminator_offset(const std::array<Vec3T<T>, 3>& vertices, const std::array<Vec3T<T>, 3>& normals,
                                   const std::array<T, 3>& weights, const Vec3T<T>& ns, const Vec3T<T>& ng,
                                   const Vec3T<T>& direction) {
    const T zero(0.0), side = select(dot(ns, ng) * dot(ng, direction) > zero, T(-1.0), T(1.0));
    T height = zero;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const T bulge = dot(normals[i] - normals[j], vertices[i] - vertices[j]) * side;
        height += weights[i] * weights[j] * max(bulge, zero);
    }
    return normalize(ns) * (side * height);
}

} // namespace duet

// Facets and the smooth surface that their vertex normals mean.
#pragma once

#include "common/vec/vec.h"

#include <array>

namespace duet {

/// From a point of a triangle to the surface that its vertex normals mean, on the side that `direction` comes from: the
/// mean of its projections onto the vertices' tangent planes (Hanika 2021; Boubekeur and Alexa 2008, «Phong
/// Tessellation»). Zero unless it lies below all of them, but for a tenth of the farthest: where the surface is flat,
/// hollow, a saddle, or its normals merely lean. weights: the point's barycentric coordinates; ng: the facet's normal, of
/// any length, as the others. T is double or a batch of doubles.
template <typename T>
Vec3T<T> lift_to_smooth(const Vec3T<T>& p, const std::array<Vec3T<T>, 3>& vertices,
                        const std::array<Vec3T<T>, 3>& normals, const std::array<T, 3>& weights, const Vec3T<T>& ng,
                        const Vec3T<T>& direction) {
    const T zero(0.0), side = select(dot(ng, direction) > zero, T(-1.0), T(1.0));
    Vec3T<T> lift(zero, zero, zero);
    T farthest = zero, least = zero;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3T<T> n = normals[i] * select(dot(normals[i], ng) < zero, -side, side);
        const T below = dot(vertices[i] - p, n);
        farthest = max(farthest, below);
        least = min(least, below);
        lift = select(below > zero, lift + n * (below * weights[i]), lift);
    }
    return select(least < T(-0.1) * farthest, Vec3T<T>(zero, zero, zero), lift);
}

} // namespace duet

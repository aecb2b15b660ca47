// This file supports sampling a flat light uniformly by area, which is nearly uniform by solid angle where the light
// is far away.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// An AreaSeen describes a flat shape as seen from a point p. area_vector is its normal with the shape's area as
/// length, and to_plane is a point of its plane relative to p. T is double, or a batch of doubles for several points
/// p.
template <typename T> struct AreaSeen {
    Vec3T<T> area_vector, to_plane;

    /// Returns whether the light is so near that it has to be sampled by solid angle, because the density of area
    /// sampling would vary much over the shape. `center` is the shape's center relative to p. For farther lights area
    /// sampling is nearly as good at a third of the cost (in the Cornell box a threshold of 0.05 gives 4 % less error
    /// for 27 % more time).
    auto near(Vec3T<T> center) const {
        constexpr double kNear = 0.3; // area over squared distance to the center
        return length(area_vector) > T(kNear) * length_squared(center);
    }
    /// Returns the density by solid angle of the point at offset w from p, for uniform area sampling: d²/(A cos
    /// θ) = d³/|A⃗·w|. A⃗·w is the same for all points of the plane. Returns 0 where p lies in the plane.
    T pdf(Vec3T<T> w) const {
        const T slant = abs(dot(area_vector, to_plane)), d2 = length_squared(w);
        return select(slant > T(0.0), d2 * sqrt(d2) / slant, T(0.0));
    }
};

} // namespace duet

// Sampling a flat light by its area, which is nearly its solid angle where it is far.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// A flat shape by its area vector (its normal, as long as its area) and a point of its plane relative to p. T is double
/// or a batch of doubles: of several points p.
template <typename T> struct AreaSeen {
    Vec3T<T> area_vector, to_plane;

    /// Whether the density by area would vary much over a shape with that centre, relative to p: where it is near, it is
    /// sampled by solid angle. Farther away that of area is nearly as good at a third of the cost (the Cornell box from
    /// 0.05 on: 4 % less error for 27 % more time).
    auto near(Vec3T<T> center) const {
        constexpr double kNear = 0.3; // area over squared distance to the centre
        return length(area_vector) > T(kNear) * length_squared(center);
    }
    /// Density by solid angle of a point at offset w from p, uniform by area: d²/(A cos θ) = d³/|A⃗·w|, where A⃗·w is the
    /// same for all points of the plane. 0 in the plane.
    T pdf(Vec3T<T> w) const {
        const T slant = abs(dot(area_vector, to_plane)), d2 = length_squared(w);
        return select(slant > T(0.0), d2 * sqrt(d2) / slant, T(0.0));
    }
};

} // namespace duet

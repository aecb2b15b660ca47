// This file samples a flat light uniformly by area (Physically Based Rendering, 3rd edition, §14.2.2; the 4th edition
// samples the solid angle of near triangles instead, §6.5.4).
// Right beside the light the density by solid angle varies without bound; multiple importance sampling with the BSDF's
// directions keeps the contributions bounded there.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// Holds a sampled direction from a point p to a shape.
template <typename T> struct SolidAngleSampleT {
    Vec3T<T> wi; ///< unit direction from p to the shape
    T distance;  ///< distance to the shape along wi
    T pdf;       ///< density by solid angle
};
using SolidAngleSample = SolidAngleSampleT<double>;
/// Returns whether a density is positive and finite as a float.
template <typename T> MaskOf<T> is_usable_pdf(T pdf) { return (pdf > T(1e-45)) & (pdf < T(1e38)); }

/// An AreaSampling describes a flat shape as seen from a point p. area_vector is its normal with the shape's area as
/// length, and to_plane is a point of its plane relative to p. T is double, or a batch of doubles for several points
/// p.
template <typename T> struct AreaSampling {
    Vec3T<T> area_vector, to_plane;

    /// Returns whether p lies on an emitting side: the front, and the back of a light that is two-sided there. A point
    /// in the light's own plane lies on neither side.
    MaskOf<T> emits(MaskOf<T> two_sided) const {
        const T front = -dot(area_vector, to_plane);
        return (front > T(0.0)) | ((front < T(0.0)) & two_sided);
    }
    /// Returns the density by solid angle of the point at offset w from p, for uniform area sampling: d²/(A cos
    /// θ) = d³/|A⃗·w|. A⃗·w is the same for all points of the plane. Returns 0 where p lies in the plane.
    T pdf(Vec3T<T> w) const {
        const T slant = abs(dot(area_vector, to_plane)), d2 = length_squared(w);
        return select(slant > T(0.0), d2 * sqrt(d2) / slant, T(0.0));
    }
    /// Returns the sample at the offset w from p, for uniform area sampling.
    SolidAngleSampleT<T> sample(Vec3T<T> w) const {
        const T distance = length(w);
        return {w / distance, distance, pdf(w)};
    }
};

/// A QuadSeen is a quad (corner + a·u + b·v) as seen from a point p.
template <typename T> struct QuadSeen : AreaSampling<T> {
    Vec3T<T> u, v;

    QuadSeen(Vec3T<T> corner, Vec3T<T> u_, Vec3T<T> v_, Vec3T<T> p)
        : AreaSampling<T>{cross(u_, v_), corner - p}, u(u_), v(v_) {}
    /// Returns the sample at the position a of the quad, for uniform area sampling.
    SolidAngleSampleT<T> sample(Vec2T<T> a) const {
        return AreaSampling<T>::sample(this->to_plane + u * a.x + v * a.y);
    }
};

} // namespace duet

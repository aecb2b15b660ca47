// This file defines the fields of a surface point that determine where rays to and from it start and end.
#pragma once

#include "common/vec/robust.h"
#include "common/vec/vec.h"

namespace duet {

/// These fields of a surface point determine where rays start and end. T is float, or a batch of floats for several
/// points.
template <typename T> struct SurfaceGeometryT {
    Vec3T<T> p;       ///< position in world space
    Vec3T<T> p_error; ///< bound on the absolute error of p, per axis
    Vec3T<T> ng; ///< unit geometric normal on the front side (counter-clockwise, outward), whichever side is visible
    Vec3T<T> ns; ///< unit shading normal in the hemisphere of ng
    /// The shading-terminator fix uses this unit normal in the hemisphere of ng. No light is reflected from or to
    /// directions below its plane. It is ns where the smooth surface lies above the triangle on the viewer's side, else
    /// ng.
    Vec3T<T> terminator_normal;
    /// The shading-terminator fix moves the origins of secondary rays by this vector, from p to the smooth surface on
    /// the viewer's side. It is (0,0,0) where terminator_normal is ng.
    Vec3T<T> terminator_offset;
};

/// Moves a point beyond its error bound to the side to which the unit normal n points. T is float or a batch of floats.
template <typename T> inline Vec3T<T> offset_origin(Vec3T<T> p, Vec3T<T> p_error, Vec3T<T> n) {
    const Vec3T<T> offset = n * dot(abs(n), p_error);
    return rounded_away(p + offset, offset);
}

/// Returns the fraction of point.terminator_offset by which a ray in direction w starts off the triangle. It is 1 where
/// w points below the triangle's plane, but above the plane of point.terminator_normal. For directions above the
/// triangle's plane it falls to 0, because the neighboring triangles of a convex surface do not block them.
template <typename T> inline T terminator_fraction(const SurfaceGeometryT<T>& point, Vec3T<T> w) {
    constexpr float kHighest = 0.25f; // sine of the elevation at and above which the fraction is 0
    const T zero(0), one(1), side = dot(point.terminator_offset, point.ng); // 0 if there is no terminator_offset
    const T elevation = select(side < zero, -dot(w, point.ng), dot(w, point.ng));
    const MaskOf<T> lifted = dot(w, point.terminator_normal) * side > zero;
    return select(lifted, clamp(one - elevation * T(1 / kHighest), zero, one), zero);
}

/// Returns the origin for a ray in direction w. The origin lies off the surface on the side of w, just beyond the error
/// bound of p, so no scene-wide epsilon is needed (Pharr, Jakob and Humphreys 2023, §6.8.6). For directions near or
/// below the triangle's plane, the ray starts from the smooth surface (p + terminator_offset) instead of the triangle.
/// Triangles near the shading terminator then do not cast stepped shadows on each other (Hanika 2021, "Hacking the
/// Shadow Terminator").
template <typename T> inline Vec3T<T> offset_origin(const SurfaceGeometryT<T>& point, Vec3T<T> w) {
    const T zero(0), fraction = terminator_fraction(point, w);
    const MaskOf<T> below =
        select(fraction > zero, dot(point.terminator_offset, point.ng), dot(w, point.ng)) < zero;
    return offset_origin(point.p + point.terminator_offset * fraction, point.p_error,
                         select(below, -point.ng, point.ng));
}

} // namespace duet

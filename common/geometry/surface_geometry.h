// This file defines what of a surface point decides where rays start and end.
#pragma once

#include "common/vec/robust.h"
#include "common/vec/vec.h"

namespace duet {

/// These fields of a surface point decide where rays origin and end. T is float, or a batch of floats for several
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

/// Returns the origin for a ray in direction w. The origin lies off the surface on the side of w, just beyond the error
/// bound of p, so no scene-wide epsilon is needed (Pharr, Jakob and Humphreys 2023, §6.8.6). For a direction above the
/// plane of point.terminator_normal, the ray starts from the smooth surface (p + terminator_offset) instead of the
/// triangle. Triangles near the shading terminator then do not cast stepped shadows on each other (Hanika 2021,
/// "Hacking the Shadow Terminator").
template <typename T> inline Vec3T<T> offset_origin(const SurfaceGeometryT<T>& point, Vec3T<T> w) {
    const T zero(0), side = dot(point.terminator_offset, point.ng); // 0 if there is no terminator_offset
    const MaskOf<T> lifted = dot(w, point.terminator_normal) * side > zero;
    const MaskOf<T> below = select(lifted, side, dot(w, point.ng)) < zero;
    return offset_origin(select(lifted, point.p + point.terminator_offset, point.p), point.p_error,
                         select(below, -point.ng, point.ng));
}

} // namespace duet

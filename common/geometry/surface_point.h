// This file defines the surface point, which holds the data for shading. Both pipelines compute it from a Hit with the
// same function.
#pragma once

#include "common/geometry/hit.h"
#include "common/geometry/shape.h"
#include "common/vec/ray.h"
#include "common/vec/robust.h"

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

struct SurfacePoint : SurfaceGeometryT<float> {
    Vec2 uv;             ///< texture coordinates
    Vec2 duv_dx, duv_dy; ///< change of uv from this sample to its neighbors; (0, 0): textures are not filtered
    Vec3 dpdu, dpdv;     ///< derivatives of p by u and v; (0,0,0) where uv are degenerate
    Vec3 p_object;       ///< p in object space, for the lookup of solid textures
    std::uint32_t object = kNoObject, primitive = 0;
    std::uint32_t material = 0; ///< index into Scene::materials
    float time = 0;
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

/// Selects the fields of a surface point to compute. Only textures need uv, its derivatives and p_object, which cost
/// more than all other fields together.
enum class SurfaceDetail { kAll, kWithoutUv };

/// Returns the surface point of a hit of a world-space ray on a shape with the transform to_world; to_object must be
/// its inverse. The caller sets object, material, duv_dx and duv_dy. With kWithoutUv, uv, dpdu and dpdv may keep their
/// defaults. Pass identity = true only if to_world is the identity; this saves the transforms.
SurfacePoint surface_point(const Shape& shape, const Hit& hit, const Ray& ray, const Mat4& to_world,
                           const Mat4& to_object, bool identity, SurfaceDetail detail = SurfaceDetail::kAll);

} // namespace duet

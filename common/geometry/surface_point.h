// What shading needs to know of a point on a surface: the one way from a Hit, for both pipelines.
#pragma once

#include "common/geometry/hit.h"
#include "common/geometry/shape.h"
#include "common/vec/ray.h"
#include "common/vec/robust.h"

namespace duet {

struct SurfacePoint {
    Vec3 p;          ///< in the world
    Vec3 p_error;    ///< bound on the absolute error of p, per axis
    Vec3 ng;         ///< geometric normal, unit: the front side (counter-clockwise, outwards), whichever side is seen
    Vec3 ns;         ///< shading normal, unit, in the hemisphere of ng
    Vec3 horizon;    ///< unit, in the hemisphere of ng: what lies below its plane neither lights nor sees this side. ng, or,
                     ///< where the surface bulges towards the viewer between smooth normals, their mean
    Vec3 lift;       ///< from p to the smooth surface over it, on the viewer's side; (0,0,0) where horizon is ng
    Vec2 uv;         ///< texture coordinates
    Vec2 duv_dx, duv_dy; ///< steps of uv from this sample to its neighbours; (0, 0): textures are not filtered
    Vec3 dpdu, dpdv; ///< change of p with uv; (0,0,0) where uv are degenerate
    Vec3 p_object;   ///< p in the object's space: where solid textures are looked up
    std::uint32_t object = kNoObject, primitive = 0;
    std::uint32_t material = 0; ///< index into Scene::materials
    float time = 0;
};

/// A ray's origin moved off the surface to the side of w, just beyond the error bound of p: no scene-wide epsilon
/// (Pharr, Jakob and Humphreys 2023, §6.8.6). Towards what lies above the horizon it starts from the smooth surface
/// instead (p + lift), so that the facets near the terminator do not shade each other in steps (Hanika 2021, «Hacking the
/// Shadow Terminator»).
Vec3 offset_origin(const SurfacePoint& point, Vec3 w);

/// Of a point with that error bound, to the side that the unit normal n points to. T is float or a batch of floats.
template <typename T> Vec3T<T> offset_origin(Vec3T<T> p, Vec3T<T> p_error, Vec3T<T> n) {
    if (sabotaged(Guard::kOffsetOrigin)) return p;
    const Vec3T<T> offset = n * dot(abs(n), p_error);
    return rounded_away(p + offset, offset);
}

/// What of a surface point is asked for: only textures look at uv, its derivatives and p_object, which cost more than
/// all the rest.
enum class SurfaceDetail { kAll, kWithoutUv };

/// The surface point of a hit of `ray` on a shape under to_world (to_object its inverse; ray in the world). Fills all
/// fields but object and material, or leaves out those that `detail` says; `identity` promises that to_world is the
/// identity, and saves the arithmetic.
SurfacePoint surface_point(const Shape& shape, const Hit& hit, const Ray& ray, const Mat4& to_world,
                           const Mat4& to_object, bool identity, SurfaceDetail detail = SurfaceDetail::kAll);

} // namespace duet

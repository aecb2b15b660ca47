// This file defines the surface point, which holds the data for shading. Both pipelines compute it from a Hit with the
// same function.
#pragma once

#include "common/geometry/hit.h"
#include "common/geometry/shape.h"
#include "common/geometry/surface_geometry.h"
#include "common/vec/ray.h"

namespace duet {

/// A SurfacePoint holds what textures, materials and lights need at a point of a surface, in world space unless noted.
struct SurfacePoint : SurfaceGeometryT<float> {
    Vec2 uv;             ///< texture coordinates
    Vec2 duv_dx, duv_dy; ///< change of uv from this sample to its neighbors; (0, 0): textures are not filtered
    Vec3 dpdu, dpdv;     ///< derivatives of p by u and v; (0,0,0) where uv are degenerate
    Vec3 p_object;       ///< p in object space, for the lookup of solid textures
    std::uint32_t object = kNoObject, primitive = 0;
    std::uint32_t material = 0; ///< index into Scene::materials
    float time = 0;
};

/// Selects the fields of a surface point to compute. Only textures need uv, its derivatives and p_object, which cost
/// more than all other fields together.
enum class SurfaceDetail { kAll, kWithoutUv };

/// Returns the surface point of a hit of a world-space ray on a shape with the transform to_world; to_object must be
/// its inverse. The caller sets object, material, duv_dx and duv_dy. With kWithoutUv, uv, dpdu and dpdv may keep their
/// defaults. Pass identity = true only if to_world is the identity; this saves the transforms.
SurfacePoint surface_point(const Shape& shape, const Hit& hit, const Ray& ray, const Mat4& to_world,
                           const Mat4& to_object, bool identity, SurfaceDetail detail = SurfaceDetail::kAll);

} // namespace duet

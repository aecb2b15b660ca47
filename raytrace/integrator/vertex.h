// A vertex of a path: a surface point with its material ready for use.
#pragma once

#include "common/vec/frame.h"
#include "raytrace/plan.h"

namespace duet::raytrace {

struct Vertex {
    SurfacePoint point;
    const Material* material;
    Bsdf bsdf;
    Frame frame; ///< about the shading normal: the space in which the BSDF works
    Vec3 wo;     ///< back along the ray, unit, in that space

    /// f(wo, wi)·|cos θᵢ| for wi in the world (unit); black where wi lies between the geometric and the shading
    /// horizon: light must not leak through the surface.
    Rgb scattered(Vec3 wi) const {
        const Vec3 local = frame.to_local(wi);
        return consistent(wi, local) ? eval(bsdf, wo, local) * abs_cos_theta(local) : Rgb();
    }
    /// Whether wi is on the same side of the surface as it is seen with the shading normal, `local` being wi in the
    /// frame. On the viewer's side a surface that bulges has a horizon of its own.
    bool consistent(Vec3 wi, Vec3 local) const {
        return dot(wi, same_hemisphere(wo, local) ? point.horizon : point.ng) * local.z > 0;
    }
};

/// The vertex at a valid hit of a ray, with the ray's footprint there, or null where the plan needs none.
Vertex make_vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint);
/// Of a camera ray.
Vertex make_vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit);
/// The surface point that a camera ray hits.
SurfacePoint camera_surface_point(const RenderPlan& plan, const Ray& ray, const Hit& hit);

/// A ray that leaves the vertex towards w (world, unit), starting off the surface.
inline Ray spawn_ray(const Vertex& vertex, Vec3 w) {
    Ray ray{offset_origin(vertex.point, w), w};
    ray.time = vertex.point.time;
    return ray;
}

} // namespace duet::raytrace

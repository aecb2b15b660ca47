// A vertex of a path: a surface point with its material ready for use.
#pragma once

#include "common/vec/frame.h"
#include "raytrace/plan.h"

#include <cmath>
#include <cstdint>

namespace duet::raytrace {

class Vertex {
public:
    /// The vertex at a valid hit of a ray, with the ray's footprint there, or null where the plan needs none. Refers to
    /// the plan.
    /// `relative_index`: of a dielectric that stands in another one, Insides'.
    Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint, float relative_index = 0);
    /// Of the camera ray of a pixel's `sample`.
    Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, std::uint32_t sample);
    Vertex(const Vertex&) = delete; // bsdf may point into it
    Vertex& operator=(const Vertex&) = delete;

    const SurfacePoint point;
    const Material& material;
    const Frame frame; ///< about the shading normal: the space in which the BSDF works
    const Vec3 wo;     ///< back along the ray, unit, in that space

private:
    std::optional<Bsdf> made_; // where a texture varies it

public:
    const Bsdf& bsdf;

    /// f(wo, wi)·|cos θᵢ| for wi in the world (unit); black where wi lies between the geometric and the shading
    /// horizon: light must not leak through the surface.
    Rgb scattered(Vec3 wi) const {
        const Vec3 local = frame.to_local(wi);
        return consistent(wi, local) ? eval(bsdf, wo, local) * abs_cos_theta(local) : Rgb();
    }
    /// Where it gathers light: on the side from which it is seen, if it only reflects.
    LightReceiver receiver() const {
        if (is_transmissive(bsdf)) return {point.p, Vec3()};
        return {point.p, wo.z < 0 ? -point.ng : point.ng};
    }
    /// Whether wi is on the same side of the surface as it is seen with the shading normal, `local` being wi in the
    /// frame. On the viewer's side a surface that bulges has a horizon of its own.
    bool consistent(Vec3 wi, Vec3 local) const {
        return dot(wi, same_hemisphere(wo, local) ? point.horizon : point.ng) * local.z > 0;
    }

private:
    Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint, float relative_index,
           std::uint32_t material_index);
};

/// The part of a pixel's width that its `sample` stands for: the samples up to it share the pixel's area. So it is the same
/// however many come after it: films that go on, and shards, have the bits of one run; and in the end nothing is blurred.
inline float footprint_width(std::uint32_t sample) { return 1 / std::sqrt(static_cast<float>(sample) + 1); }
/// The footprint of the camera ray of a pixel's `sample` at its hit; empty where the plan needs none.
std::optional<RayFootprint> camera_footprint(const RenderPlan& plan, const Ray& ray, const Hit& hit, std::uint32_t sample);
/// The surface point that it hits.
SurfacePoint camera_surface_point(const RenderPlan& plan, const Ray& ray, const Hit& hit, std::uint32_t sample);

/// A ray that leaves the vertex towards w (world, unit), starting off the surface.
inline Ray spawn_ray(const Vertex& vertex, Vec3 w) {
    Ray ray{offset_origin(vertex.point, w), w};
    ray.time = vertex.point.time;
    return ray;
}

} // namespace duet::raytrace

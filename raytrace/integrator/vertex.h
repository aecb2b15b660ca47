// Declares the vertex of a path: a surface point with its BSDF.
#pragma once

#include "common/vec/frame.h"
#include "raytrace/render_plan.h"

#include <cmath>
#include <cstdint>

namespace duet::raytrace {

/// Holds the properties of a surface that depend on what the path has passed before.
struct Boundary {
    float relative_index = 0;  ///< MediumStack::relative_index() for a dielectric inside another one, else 0
    bool leaves_solid = false; ///< whether light leaves a solid there after subsurface scattering
};

/// Represents a vertex of a path on a surface.
class Vertex {
public:
    /// Constructs the vertex at a valid hit of a ray. `footprint` is the ray's footprint there, or null if the plan
    /// needs none. The vertex refers to the plan.
    Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint,
           const Boundary& boundary = {});
    /// Constructs the vertex at a valid hit of the camera ray of sample `sample` of a pixel.
    Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, std::uint32_t sample);
    Vertex(const Vertex&) = delete; // bsdf may point into the vertex
    Vertex& operator=(const Vertex&) = delete;

    const SurfacePoint point;
    const Material& material;
    const Frame frame; ///< local space of the BSDF, around the shading normal
    const Vec3 wo;     ///< unit direction back along the ray, in the local space

private:
    std::optional<Bsdf> own_bsdf_; // the BSDF, if it is not constant

public:
    const Bsdf& bsdf;

private:
    Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint,
           const Boundary& boundary, std::uint32_t material_index);
    const Bsdf& make_bsdf(const RenderPlan& plan, const Boundary& boundary);
};

/// Returns an origin offset from point.p + offset, or from point.p if another surface lies between the two. The offset
/// must not be 0.
Vec3 origin_on_smooth_surface(const RenderPlan& plan, const SurfaceGeometryT<float>& point, Vec3 offset, float time);

// The functions below are templates over the vertex: a Vertex, or the vertices of several paths in SIMD lanes
// (BatchVertex), with the same members. T is the number type.

/// Returns the direction back along a ray of the given direction (world space, unit) in a vertex's frame.
template <typename T> inline Vec3T<T> direction_to_viewer(const FrameT<T>& frame, Vec3T<T> ng, Vec3T<T> ray_direction) {
    const Vec3T<T> wo = -ray_direction;
    return clamp_to_visible_side(frame.to_local(wo), select(dot(wo, ng) < T(0), T(-1), T(1)));
}
/// Returns the light receiver: on the visible side of the surface, or on both sides if the BSDF transmits.
template <typename AnyVertex> inline auto light_receiver(const AnyVertex& vertex) {
    using T = decltype(vertex.wo.z);
    if (is_transmissive(vertex.bsdf)) return LightReceiverT<T>{vertex.point.p, Vec3T<T>(T(0), T(0), T(0))};
    return LightReceiverT<T>{vertex.point.p, select(vertex.wo.z < T(0), -vertex.point.ng, vertex.point.ng)};
}
/// Returns whether wi is on the same side of the geometric surface and of the shading normal. `local` is wi in the
/// frame. On the viewer's side, `terminator_normal` replaces the geometric normal (shading terminator fix).
template <typename AnyVertex, typename T>
inline MaskOf<T> is_consistent(const AnyVertex& vertex, Vec3T<T> wi, Vec3T<T> local) {
    const Vec3T<T> normal = select(same_hemisphere(vertex.wo, local), vertex.point.terminator_normal, vertex.point.ng);
    return dot(wi, normal) * local.z > T(0);
}
/// Returns f(wo, wi)·|cos θᵢ| for wi in world space (unit). It is black where the geometric and the shading normal
/// disagree about the side of wi, because light must not leak through the surface.
template <typename AnyVertex, typename T> inline RgbT<T> scattering(const AnyVertex& vertex, Vec3T<T> wi) {
    const Vec3T<T> local = vertex.frame.to_local(wi);
    const MaskOf<T> consistent = is_consistent(vertex, wi, local);
    if (none_of(consistent)) return RgbT<T>(T(0));
    return select(consistent, eval(vertex.bsdf, vertex.wo, local) * abs_cos_theta(local), RgbT<T>(T(0)));
}

/// Returns the density by solid angle with which sampling the BSDF draws wi (world space, unit).
template <typename AnyVertex, typename T> inline T scattering_pdf(const AnyVertex& vertex, Vec3T<T> wi) {
    return pdf(vertex.bsdf, vertex.wo, vertex.frame.to_local(wi));
}

/// Returns the fraction of a pixel's width that sample `sample` covers, if it shares the pixel's area with the samples
/// before it. It does not depend on the number of samples that follow, so that continued films and shards are bit-equal
/// to a single run. In the limit nothing is blurred.
inline float footprint_width(std::uint32_t sample) { return 1 / std::sqrt(static_cast<float>(sample) + 1); }
/// Returns the footprint of the camera ray of sample `sample` of a pixel at its hit, or nothing if the plan needs none.
std::optional<RayFootprint> camera_footprint(const RenderPlan& plan, const Ray& ray, const Hit& hit,
                                             std::uint32_t sample);
/// Returns the surface point that this camera ray hits.
SurfacePoint camera_surface_point(const RenderPlan& plan, const Ray& ray, const Hit& hit, std::uint32_t sample);

/// Returns the origin of a ray that leaves a point toward w (world space, unit). It is offset_origin(point, w), unless
/// another surface lies between that origin and the point. From beyond such a surface, the ray would miss it, or hit it
/// from inside.
inline Vec3 ray_origin(const RenderPlan& plan, const SurfaceGeometryT<float>& point, Vec3 w, float time) {
    const float fraction = terminator_fraction(point, w);
    return fraction > 0 ? origin_on_smooth_surface(plan, point, point.terminator_offset * fraction, time)
                        : offset_origin(point, w);
}

/// Returns a ray that leaves the vertex toward w (world space, unit). Its origin is offset from the surface.
inline Ray spawn_ray(const RenderPlan& plan, const Vertex& vertex, Vec3 w) {
    Ray ray{ray_origin(plan, vertex.point, w, vertex.point.time), w};
    ray.time = vertex.point.time;
    return ray;
}

} // namespace duet::raytrace

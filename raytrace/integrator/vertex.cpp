#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

namespace {

const RayFootprint* pointer(const std::optional<RayFootprint>& footprint) { return footprint ? &*footprint : nullptr; }

/// Returns a dielectric with its index of refraction relative to the dielectric around it.
Material with_index(const Material& material, float eta) {
    Dielectric other = std::get<Dielectric>(material);
    other.ior = eta;
    return other;
}

} // namespace

Vec3 origin_on_smooth_surface(const RenderPlan& plan, const SurfaceGeometryT<float>& point, Vec3 offset, float time) {
    const Vec3 n = dot(offset, point.ng) < 0 ? -point.ng : point.ng;
    const float distance = length(offset);
    if (!(distance > 0)) return offset_origin(point.p, point.p_error, n); // the square underflowed
    Ray ray{offset_origin(point.p, point.p_error, n), offset / distance};
    ray.time = time;
    Hit end;
    end.t = distance;
    if (plan.prepared.accelerator.occluded(ray, end)) return ray.origin;
    return offset_origin(point.p + offset, point.p_error, n);
}

std::optional<RayFootprint> camera_footprint(const RenderPlan& plan, const Ray& ray, const Hit& hit,
                                             std::uint32_t sample) {
    return plan.pixel_footprint ? std::optional(plan.pixel_footprint->at(ray, hit.t) * footprint_width(sample))
                                : std::nullopt;
}

SurfacePoint camera_surface_point(const RenderPlan& plan, const Ray& ray, const Hit& hit, std::uint32_t sample) {
    return surface_point(plan.scene, ray, hit, pointer(camera_footprint(plan, ray, hit, sample)));
}

Vertex::Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, std::uint32_t sample)
    : Vertex(plan, ray, hit, pointer(camera_footprint(plan, ray, hit, sample))) {}

Vertex::Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint,
               const Boundary& boundary)
    : Vertex(plan, ray, hit, footprint, boundary, material_index(plan.scene, hit.object, hit.primitive)) {}

Vertex::Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint,
               const Boundary& boundary, std::uint32_t material_index)
    : point(surface_point(plan.scene, ray, hit, footprint, plan.details[material_index])),
      material(plan.scene.materials[material_index]), frame(frame_from_normal(point.ns)),
      wo(direction_to_viewer(frame, point.ng, ray.direction)),
      bsdf(make_bsdf(plan, boundary)) {}

const Bsdf& Vertex::make_bsdf(const RenderPlan& plan, const Boundary& boundary) {
    const TextureSet& textures = plan.scene.textures;
    if (boundary.leaves_solid) return own_bsdf_.emplace(subsurface_exit_at(material, textures, point));
    if (boundary.relative_index != 0)
        return own_bsdf_.emplace(bsdf_at(with_index(material, boundary.relative_index), textures, point));
    if (plan.subsurface && wo.z > 0 && has_subsurface(material))
        return own_bsdf_.emplace(subsurface_at(material, textures, point));
    if (const std::optional<Bsdf>& constant = (*plan.bsdfs)[point.material]) return *constant;
    return own_bsdf_.emplace(bsdf_at(material, textures, point));
}

} // namespace duet::raytrace

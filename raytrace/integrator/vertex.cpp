#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

namespace {

// Textures alone ask for more than position and normals.
SurfaceDetail detail(const RenderPlan& plan, std::uint32_t material) {
    return (*plan.bsdfs)[material] ? SurfaceDetail::kWithoutUv : SurfaceDetail::kAll;
}

Vec3 towards_viewer(const Frame& frame, Vec3 ng, Vec3 direction) {
    const Vec3 wo = -direction; // unit: all rays in the world are
    return lifted_above_horizon(frame.to_local(wo), dot(wo, ng) < 0 ? -1.0f : 1.0f);
}

const Bsdf& made_or_constant(const RenderPlan& plan, std::uint32_t material, const SurfacePoint& point,
                             std::optional<Bsdf>& made) {
    if (const std::optional<Bsdf>& constant = (*plan.bsdfs)[material]) return *constant;
    return made.emplace(bsdf_at(plan.scene.materials[material], plan.scene.textures, point));
}

} // namespace

Vertex::Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit)
    : Vertex(plan, ray, hit, material_index(plan.scene, hit.object, hit.primitive)) {}

Vertex::Vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, std::uint32_t material_index)
    : point(surface_point(plan.scene, ray, hit, detail(plan, material_index))),
      material(plan.scene.materials[material_index]), frame(frame_from_normal(point.ns)),
      wo(towards_viewer(frame, point.ng, ray.direction)),
      bsdf(made_or_constant(plan, material_index, point, made_)) {}

} // namespace duet::raytrace

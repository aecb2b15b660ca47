#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

Vertex make_vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit) {
    Vertex vertex;
    const std::uint32_t material = material_index(plan.scene, hit.object, hit.primitive);
    const std::optional<Bsdf>& constant = (*plan.bsdfs)[material];
    const SurfaceDetail detail = constant ? SurfaceDetail::kWithoutUv : SurfaceDetail::kAll;
    vertex.point = surface_point(plan.scene, ray, hit, detail);
    vertex.material = &plan.scene.materials[material];
    vertex.bsdf = constant ? *constant : bsdf_at(*vertex.material, plan.scene.textures, vertex.point);
    vertex.frame = frame_from_normal(vertex.point.ns);
    const Vec3 wo = -ray.direction; // unit: all rays in the world are
    vertex.wo = lifted_above_horizon(vertex.frame.to_local(wo), dot(wo, vertex.point.ng) < 0 ? -1.0f : 1.0f);
    return vertex;
}

} // namespace duet::raytrace

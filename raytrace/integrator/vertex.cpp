#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

Vertex make_vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit) {
    Vertex vertex;
    vertex.point = surface_point(plan.scene, ray, hit);
    vertex.material = &plan.scene.materials[vertex.point.material];
    const std::optional<Bsdf>& constant = (*plan.bsdfs)[vertex.point.material];
    vertex.bsdf = constant ? *constant : bsdf_at(*vertex.material, plan.scene.textures, vertex.point);
    vertex.frame = frame_from_normal(vertex.point.ns);
    const Vec3 wo = -normalize(ray.direction);
    vertex.wo = lifted_above_horizon(vertex.frame.to_local(wo), dot(wo, vertex.point.ng) < 0 ? -1.0f : 1.0f);
    return vertex;
}

} // namespace duet::raytrace

#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

SurfacePoint camera_surface_point(const RenderPlan& plan, const Ray& ray, const Hit& hit) {
    if (!plan.pixel) return surface_point(plan.scene, ray, hit);
    const RayFootprint footprint = plan.pixel->at(ray, hit.t);
    return surface_point(plan.scene, ray, hit, &footprint);
}

Vertex make_vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit) {
    if (!plan.pixel) return make_vertex(plan, ray, hit, nullptr);
    const RayFootprint footprint = plan.pixel->at(ray, hit.t);
    return make_vertex(plan, ray, hit, &footprint);
}

Vertex make_vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint) {
    Vertex vertex;
    vertex.point = surface_point(plan.scene, ray, hit, footprint);
    vertex.material = &plan.scene.materials[vertex.point.material];
    const std::optional<Bsdf>& constant = (*plan.bsdfs)[vertex.point.material];
    vertex.bsdf = constant ? *constant : bsdf_at(*vertex.material, plan.scene.textures, vertex.point);
    vertex.frame = frame_from_normal(vertex.point.ns);
    const Vec3 wo = -normalize(ray.direction);
    vertex.wo = lifted_above_horizon(vertex.frame.to_local(wo), dot(wo, vertex.point.ng) < 0 ? -1.0f : 1.0f);
    return vertex;
}

} // namespace duet::raytrace

#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

namespace {

// Interpolated normals make surfaces near their silhouette face away though they are seen. The side that is seen is the
// geometric one: a direction below that side's shading horizon is lifted just above it, or the silhouettes were black.
Vec3 lifted(Vec3 wo, float geometric_cosine) {
    constexpr float kLowest = 1e-4f;
    const float side = geometric_cosine < 0 ? -1.0f : 1.0f;
    if (wo.z * side >= kLowest) return wo;
    const float flat = std::sqrt(wo.x * wo.x + wo.y * wo.y);
    if (flat == 0) return {0, 0, side};
    const float scale = std::sqrt(1 - kLowest * kLowest) / flat;
    return {wo.x * scale, wo.y * scale, kLowest * side};
}

} // namespace

Vertex make_vertex(const RenderPlan& plan, const Ray& ray, const Hit& hit) {
    Vertex vertex;
    vertex.point = surface_point(plan.scene, ray, hit);
    vertex.material = &plan.scene.materials[vertex.point.material];
    const std::optional<Bsdf>& constant = plan.prepared.bsdfs[vertex.point.material];
    vertex.bsdf = constant ? *constant : bsdf_at(*vertex.material, plan.scene.textures, vertex.point);
    vertex.frame = frame_from_normal(vertex.point.ns);
    const Vec3 wo = -normalize(ray.direction);
    vertex.wo = lifted(vertex.frame.to_local(wo), dot(wo, vertex.point.ng));
    return vertex;
}

} // namespace duet::raytrace

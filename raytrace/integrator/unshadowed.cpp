// Emission, and direct light as if nothing stood in its way: what the rasterizer computes in closed form, by light
// sampling.
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/light_sampling.h"

namespace duet::raytrace {

namespace {

// A mirror or glass shows the environment, and none of what stands before it.
Rgb mirrored_environment(const RenderPlan& plan, const Vertex& vertex, VertexDimensions dimensions, Sampler& sampler) {
    if (plan.environment == nullptr) return Rgb();
    sampler.set_dimension(dimensions.lobe());
    const float lobe = sampler.get_1d();
    sampler.set_dimension(dimensions.bsdf());
    const auto s = sample(vertex.bsdf, vertex.wo, lobe, sampler.get_2d());
    if (!s) return Rgb();
    const Vec3 wi = normalize(vertex.frame.to_world(s->wi));
    return vertex.consistent(wi, s->wi) ? s->weight * radiance(*plan.environment, wi) : Rgb();
}

} // namespace

Rgb unshadowed_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts&) {
    if (!hit.valid()) return plan.environment ? radiance(*plan.environment, normalize(ray.direction)) : Rgb();
    const Vertex vertex = make_vertex(plan, ray, hit);
    const Rgb emission = emitted(*vertex.material, plan.scene.textures, vertex.point, -ray.direction);
    if (plan.max_depth == 0) return emission;
    const VertexDimensions dimensions(0);
    if (is_specular(vertex.bsdf)) return emission + mirrored_environment(plan, vertex, dimensions, sampler);
    if (plan.lights == nullptr) return emission;
    sampler.set_dimension(dimensions.light_choice());
    const float choice = sampler.get_1d();
    sampler.set_dimension(dimensions.light());
    const auto arrival = sample_arrival(plan.scene, *plan.lights, vertex.point.p, choice, sampler.get_2d());
    if (!arrival) return emission;
    return emission + vertex.scattered(arrival->wi) * arrival->radiance / arrival->pdf;
}

} // namespace duet::raytrace

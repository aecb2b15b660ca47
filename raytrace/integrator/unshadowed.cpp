// This integrator computes emission, and direct light without occlusion, by light sampling. The rasterizer computes
// the same quantity in closed form.
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/light_sampling.h"

namespace duet::raytrace {

namespace {

// Returns the environment's light as BSDF samples find it, without occlusion. At mirrors and glass there is no other
// light.
Rgb environment_found(const RenderPlan& plan, const Vertex& vertex, const VertexNumbers& u) {
    if (plan.environment == nullptr) return Rgb();
    const auto s = sample(vertex.bsdf, vertex.wo, u.lobe, u.bsdf);
    if (!s) return Rgb();
    const Vec3 wi = normalize(vertex.frame.to_world(s->wi));
    if (!vertex.consistent(wi, s->wi)) return Rgb();
    const bool sampled = plan.lights != nullptr && !s->specular;
    const float other = sampled ? arrival_pdf(*plan.environment, *plan.lights, vertex.receiver(), wi) : 0.0f;
    return s->weight * radiance(*plan.environment, wi) * mis_weight(s->pdf, other);
}

Rgb light_sampled(const RenderPlan& plan, const Vertex& vertex, const VertexNumbers& u) {
    if (plan.lights == nullptr || is_specular(vertex.bsdf)) return Rgb();
    const auto arrival = sample_arrival(plan.scene, *plan.lights, vertex.receiver(), u.light_choice, u.light);
    if (!arrival) return Rgb();
    const Rgb light = vertex.scattered(arrival->wi) * arrival->radiance / arrival->pdf;
    if (arrival->light >= 0) return light;
    return light * mis_weight(arrival->pdf, pdf(vertex.bsdf, vertex.wo, vertex.frame.to_local(arrival->wi)));
}

} // namespace

Rgb unshadowed_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts&) {
    if (!hit.valid()) return plan.environment ? radiance(*plan.environment, ray.direction) : Rgb();
    const Vertex vertex(plan, ray, hit, sampler.sample());
    const Rgb emission = emitted(vertex.material, plan.scene.textures, vertex.point, -ray.direction);
    if (plan.max_depth == 0) return emission;
    const VertexNumbers u = vertex_numbers(sampler, 0);
    return emission + environment_found(plan, vertex, u) + light_sampled(plan, vertex, u);
}

} // namespace duet::raytrace

// This integrator computes emission, and direct light without occlusion, by light sampling. The rasterizer computes
// the same quantity in closed form.
#include "raytrace/integrator/path.h"

namespace duet::raytrace {

namespace {

// Returns the environment's light as BSDF samples find it, without occlusion. At mirrors and glass there is no other
// light.
Rgb environment_found(const RenderPlan& plan, const Vertex& vertex, const VertexNumbers& u) {
    if (plan.environment == nullptr) return Rgb();
    PathState state;
    const ScatteringT<float> next = scatter(vertex, u, state);
    if (!next.continues) return Rgb();
    const Departure from{light_receiver(vertex), next.sample->pdf, next.sample->specular || plan.lights == nullptr};
    const float light_pdf = from.certain ? 0 : arrival_pdf(*plan.environment, *plan.lights, from.receiver, next.wi);
    return state.throughput * radiance(*plan.environment, next.wi) * found_light_weight(from, light_pdf);
}

Rgb light_sampled(const RenderPlan& plan, const Vertex& vertex, const VertexNumbers& u) {
    if (plan.lights == nullptr || is_specular(vertex.bsdf)) return Rgb();
    const auto arrival = sample_arrival(plan.scene, *plan.lights, light_receiver(vertex), u.light_choice, u.light);
    if (!arrival) return Rgb();
    const Rgb light = scattered_light(vertex, *arrival) / arrival->pdf;
    return arrival->light >= 0 ? light : light * light_sample_weight(vertex, *arrival);
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

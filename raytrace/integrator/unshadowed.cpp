// Implements the integrator that computes emission, and direct light without occlusion, by light sampling. The
// rasterizer computes the same quantity in closed form.
#include "raytrace/integrator/path.h"

namespace duet::raytrace {

namespace {

// Returns the environment's light that BSDF samples find, without occlusion. Mirrors and glass reflect no other light
// here.
Rgb environment_by_bsdf_sampling(const RenderPlan& plan, const Vertex& vertex, const VertexRandomSamples& u) {
    if (plan.environment == nullptr) return Rgb();
    PathState state;
    const ScatteringT<float> next = scatter(vertex, u, state);
    if (!next.continues) return Rgb();
    const PreviousVertex previous{light_receiver(vertex), next.sample->pdf,
                                  next.sample->specular || plan.lights == nullptr};
    const float light_pdf =
        previous.no_light_sample ? 0 : pdf_li(*plan.environment, *plan.lights, previous.receiver, next.wi);
    return state.throughput * radiance(*plan.environment, next.wi) * found_light_weight(previous, light_pdf);
}

Rgb light_by_light_sampling(const RenderPlan& plan, const Vertex& vertex, const VertexRandomSamples& u) {
    if (plan.lights == nullptr || is_specular(vertex.bsdf)) return Rgb();
    const auto light_sample = sample_li(plan.scene, *plan.lights, light_receiver(vertex), u.light_choice, u.light);
    if (!light_sample) return Rgb();
    const Rgb light = light_toward_viewer(vertex, *light_sample) / light_sample->pdf;
    return light_sample->light >= 0 ? light : light * light_sample_weight(vertex, *light_sample);
}

} // namespace

Rgb unshadowed_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts&) {
    if (!hit.valid()) return plan.environment ? radiance(*plan.environment, ray.direction) : Rgb();
    const Vertex vertex(plan, ray, hit, sampler.sample());
    const Rgb emission = emitted(vertex.material, plan.scene.textures, vertex.point, -ray.direction);
    if (plan.max_depth == 0) return emission;
    const VertexRandomSamples u = vertex_random_samples(sampler, 0);
    return emission + environment_by_bsdf_sampling(plan, vertex, u) + light_by_light_sampling(plan, vertex, u);
}

} // namespace duet::raytrace

// Implements the ray tracer of Whitted (1980, "An Improved Illumination Model for Shaded Display"), with which most
// tutorials begin. It follows rays through mirrors and glass to the first other surface, which every light illuminates
// from its center, so that shadows are hard. Surfaces do not light each other.
#include "raytrace/integrator/path.h"

namespace duet::raytrace {

namespace {

// Returns the light that the vertex scatters from the center of one light.
Rgb light_from_center(const RenderPlan& plan, const Vertex& vertex, std::size_t index, RayCounts& counts) {
    const std::optional<LightSample> s = sample_light(plan.scene.lights[index], vertex.point.p, {0.5f, 0.5f});
    if (!s) return Rgb();
    const LightLiSample light = light_sample(*s, {index, 1, 0});
    const Rgb scattered = light_toward_viewer(vertex, light) / light.pdf;
    if (is_black(scattered)) return Rgb();
    ++counts.shadow;
    return unoccluded(plan, vertex, light) ? scattered : Rgb();
}

// Returns the environment's light without occlusion. It replaces the ambient light of the tutorials.
Rgb ambient_light(const RenderPlan& plan, const Vertex& vertex, const VertexRandomSamples& u) {
    if (plan.environment == nullptr) return Rgb();
    PathState state;
    const ScatteringT<float> next = scatter(vertex, u, state);
    return next.continues ? state.throughput * radiance(*plan.environment, next.wi) : Rgb();
}

Rgb direct_light(const RenderPlan& plan, const Vertex& vertex, const VertexRandomSamples& u, RayCounts& counts) {
    Rgb sum = ambient_light(plan, vertex, u);
    for (std::size_t i = 0; i < plan.scene.lights.size(); ++i) sum += light_from_center(plan, vertex, i, counts);
    return sum;
}

} // namespace

// At glass, one of the reflected and the refracted ray is chosen at random. The mean of many samples contains both.
Rgb whitted_radiance(const RenderPlan& plan, const Ray& camera_ray, const Hit& first_hit, Sampler& sampler,
                     RayCounts& counts) {
    Ray ray = camera_ray;
    Hit hit = first_hit;
    Rgb sum;
    PathState state;
    PathFootprint footprint(plan, sampler.sample());
    for (int depth = 0;; ++depth) {
        if (!hit.valid())
            return plan.environment ? sum + state.throughput * radiance(*plan.environment, ray.direction) : sum;
        const Vertex vertex(plan, ray, hit, footprint.at_hit(ray, hit.t));
        sum += state.throughput * emitted(vertex.material, plan.scene.textures, vertex.point, -ray.direction);
        if (depth == plan.max_depth) return sum;
        const VertexRandomSamples u = vertex_random_samples(sampler, depth);
        if (!is_specular(vertex.bsdf)) return sum + state.throughput * direct_light(plan, vertex, u, counts);
        const ScatteringT<float> next = scatter(vertex, u, state);
        if (!next.continues) return sum;
        ray = spawn_ray(plan, vertex, next.wi);
        hit = plan.prepared.accelerator.closest(ray);
        ++counts.indirect;
    }
}

} // namespace duet::raytrace

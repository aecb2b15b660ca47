// Implements the integrators that compute only one component of the light, to show it and to measure its cost. Paths
// continue only if they can still find this component.
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

namespace {

bool is_diffuse(const RenderPlan& plan, const Ray& ray, const Hit& hit, const Sampler& sampler) {
    return duet::is_diffuse(Vertex(plan, ray, hit, sampler.sample()).bsdf);
}

} // namespace

// Computes emission and direct light. The plan ends paths after one scattering.
Rgb lights_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    const LightComponents components = path_components(plan, ray, hit, sampler, counts);
    return components.emission + components.direct;
}

// Computes the environment's light. The plan samples only the environment, and ends paths after one scattering.
Rgb environment_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    if (plan.environment == nullptr || !hit.valid() || !is_diffuse(plan, ray, hit, sampler)) return Rgb();
    return path_components(plan, ray, hit, sampler, counts).environment;
}

Rgb reflection_radiance(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, RayCounts& counts) {
    if (!hit.valid() || is_diffuse(plan, ray, hit, sampler)) return Rgb();
    return path_components(plan, ray, hit, sampler, counts).reflection;
}

} // namespace duet::raytrace

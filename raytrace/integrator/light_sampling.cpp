#include "raytrace/integrator/light_sampling.h"

#include "common/geometry/quad.h"
#include "common/scene/emitter_texture.h"
#include "common/vec/robust.h"

namespace duet::raytrace {

std::optional<LightLiSample> sample_li(const Scene& scene, const LightSampler& lights, const LightReceiver& receiver,
                                       float choice, Vec2 u) {
    const std::optional<SampledLight> chosen = lights.sample(receiver, choice);
    return chosen ? sample_li(scene, lights, receiver, *chosen, u) : std::nullopt;
}

std::optional<LightLiSample> sample_li(const Scene& scene, const LightSampler& lights, const LightReceiver& receiver,
                                       const SampledLight& chosen, Vec2 u) {
    if (chosen.index == lights.environment_index()) {
        const std::optional<EnvironmentSample> s = sample(scene.environment, u);
        if (!s) return std::nullopt;
        return LightLiSample{{s->wi, s->radiance, s->pdf * chosen.probability, false}, kInfinity, -1};
    }
    std::optional<LightSample> s = sample_light(scene.lights[chosen.index], receiver.p, u);
    if (!s) return std::nullopt;
    if (scene.needs.emitter_textures)
        if (const auto* surface = std::get_if<SurfaceLight>(&scene.lights[chosen.index]))
            s->radiance = radiance_toward(scene, *surface, receiver.p, s->wi, s->distance);
    return light_sample(*s, chosen);
}

namespace {

// Returns the distance at which a ray toward a flat light hits it. The test is the same as for all other hits, so that
// surfaces in the light's plane have the same order relative to the light as for any ray. A ray toward the light's edge
// may miss it by a rounding error; then the result is `sampled`.
float distance_to_light(const Ray& ray, const SurfaceLight& light, float sampled) {
    if (const auto* quad = std::get_if<Quad>(&light.shape)) {
        if (const auto hit = intersect_quad(ShearedRay(ray), *quad)) return hit->t;
    } else if (const auto* t = std::get_if<SurfaceLight::Triangle>(&light.shape)) {
        if (const auto hit = intersect_triangle(ShearedRay(ray), t->a, t->b, t->c)) return hit->t;
    }
    return sampled;
}

} // namespace

ShadowRayEnd::ShadowRayEnd(const Scene& scene, const Ray& ray, Vec3 p, const LightLiSample& light_sample)
    : sampled_distance_(light_sample.distance) {
    if (light_sample.light >= 0)
        light_ = std::get_if<SurfaceLight>(&scene.lights[static_cast<std::size_t>(light_sample.light)]);
    if (light_ == nullptr) {
        // A point light may lie in a surface, which must not occlude it. The ray therefore ends a rounding error before
        // the light.
        end_.t = light_sample.delta ? light_sample.distance * (1 - gamma_bound(8)) - length(ray.origin - p)
                                    : light_sample.distance;
        return;
    }
    end_.object = light_->object;
    end_.primitive = light_->primitive;
    // Mostly nothing is hit before the light or just behind it. The light's exact distance then does not matter.
    end_.t = light_sample.distance * 1.001f;
}

Hit ShadowRayEnd::exact(const Ray& ray) const {
    Hit end = end_;
    if (light_ != nullptr) end.t = distance_to_light(ray, *light_, sampled_distance_);
    return end;
}

bool unoccluded(const RenderPlan& plan, const Ray& ray, const ShadowRayEnd& end) {
    if (!plan.prepared.accelerator.occluded(ray, end.conservative())) return true;
    return end.is_surface() && !plan.prepared.accelerator.occluded(ray, end.exact(ray));
}

float pdf_li(const Scene& scene, const LightSampler& lights, const LightReceiver& receiver, const SurfacePoint& point) {
    const std::int64_t index = surface_light_index(scene, point.object, point.primitive);
    if (index < 0) return 0;
    const auto i = static_cast<std::size_t>(index);
    const float chosen = lights.probability(receiver, i);
    return chosen > 0 ? chosen * light_pdf(std::get<SurfaceLight>(scene.lights[i]), receiver.p, point.p) : 0.0f;
}

float pdf_li(const Environment& environment, const LightSampler& lights, const LightReceiver& receiver, Vec3 w) {
    const float density = pdf(environment, w);
    return density > 0 ? density * lights.probability(receiver, lights.environment_index()) : 0.0f;
}

} // namespace duet::raytrace

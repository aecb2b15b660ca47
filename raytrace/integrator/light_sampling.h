// One light sample at a vertex, and its weight against BSDF sampling.
#pragma once

#include "common/light/light_choice.h"
#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

/// Light that could arrive at a point from a light or the environment.
struct Arrival {
    Vec3 wi;                 ///< unit, in the world
    Rgb radiance;            ///< as LightSample::radiance
    float pdf = 0;           ///< by solid angle, the choice of the light included; > 0
    bool delta = false;      ///< BSDF samples cannot find it
    float distance = 0;      ///< infinity for the sun and the environment
    std::int64_t light = -1; ///< index into Scene::lights; −1: the environment
};
/// choice in [0, 1) chooses the light, u in [0, 1)² the point on it. Empty where the chosen one sends nothing.
std::optional<Arrival> sample_arrival(const Scene& scene, const LightChooser& lights, const LightReceiver& receiver,
                                      float choice, Vec2 u);
/// The same from the light that was chosen.
std::optional<Arrival> sample_arrival(const Scene& scene, const LightChooser& lights, const LightReceiver& receiver,
                                      const LightChoice& chosen, Vec2 u);

/// Where a shadow ray to an arrival's light ends, if it leaves the surface point p.
class ShadowEnd {
public:
    ShadowEnd(const Scene& scene, const Ray& ray, Vec3 p, const Arrival& arrival);
    /// The end, or, of a surface, a place just behind it: where nothing stands before that, nothing is in the way.
    const Hit& about() const { return end_; }
    Hit exact(const Ray& ray) const;
    bool is_surface() const { return light_ != nullptr; }
    /// Whether the light is where the ray meets it, if it does.
    bool is_flat() const { return is_surface() && !std::holds_alternative<Sphere>(light_->shape); }

private:
    const SurfaceLight* light_ = nullptr;
    float sampled_;
    Hit end_;
};

/// Whether nothing stands between the vertex and the light. Sends one shadow ray.
bool reaches(const RenderPlan& plan, const Ray& ray, const ShadowEnd& end); ///< the ray to that end
inline bool reaches(const RenderPlan& plan, const Vertex& vertex, const Arrival& arrival) {
    const Ray ray = spawn_ray(vertex, arrival.wi);
    return reaches(plan, ray, ShadowEnd(plan.scene, ray, vertex.point.p, arrival));
}

/// The density with which sample_arrival returns the direction to `point`, which lies on an emissive surface: 0 where
/// that is no light that is sampled (it moves, or does not emit towards the receiver).
float arrival_pdf(const Scene& scene, const LightChooser& lights, const LightReceiver& receiver,
                  const SurfacePoint& point);
/// The same of a direction w to the environment.
float arrival_pdf(const Environment& environment, const LightChooser& lights, const LightReceiver& receiver, Vec3 w);

/// The weight of a sample that was drawn with density `own` and could have been drawn with density `other`: the power
/// heuristic, β = 2 (Veach 1997, §9.2.4). own > 0.
template <typename T> T mis_weight(T own, T other) { return T(1.0f) / (T(1.0f) + sqr(other / own)); }

} // namespace duet::raytrace

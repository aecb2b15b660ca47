// Declares light samples. A vertex draws one light sample, which is weighted against BSDF sampling.
#pragma once

#include "raytrace/integrator/vertex.h"
#include "raytrace/sampling/light_sampler.h"

namespace duet::raytrace {

/// Holds a light sample: light that arrives at a point from a light or the environment, unless it is occluded. T is
/// float, or a batch of floats for one light sample per lane.
template <typename T> struct LightLiSampleT {
    Vec3T<T> wi;                        ///< unit direction to the light, in world space
    RgbT<T> radiance;                   ///< see LightSample::radiance
    T pdf{};                            ///< density by solid angle, including the probability of the light; > 0
    MaskOf<T> delta = MaskOf<T>(false); ///< whether BSDF samples cannot find it
};
/// Holds a light sample of a single path.
struct LightLiSample : LightLiSampleT<float> {
    float distance = 0;      ///< infinity for the sun and the environment
    std::int64_t light = -1; ///< index into Scene::lights; −1: the environment
};
/// Returns the sample of a light that was chosen as described by `chosen`.
inline LightLiSample light_sample(const LightSample& s, const SampledLight& chosen) {
    return {
        {s.wi, s.radiance, s.pdf * chosen.probability, s.delta}, s.distance, static_cast<std::int64_t>(chosen.index)};
}
/// Draws a light sample: `choice` in [0, 1) chooses the light, and `u` in [0, 1)² the point on it. Returns nothing
/// if the chosen light sends no light to the receiver.
std::optional<LightLiSample> sample_li(const Scene& scene, const LightSampler& lights, const LightReceiver& receiver,
                                       float choice, Vec2 u);
/// Draws a sample of the light that was already chosen.
std::optional<LightLiSample> sample_li(const Scene& scene, const LightSampler& lights, const LightReceiver& receiver,
                                       const SampledLight& chosen, Vec2 u);

/// Computes the end of a shadow ray from the surface point p to a light sample.
class ShadowRayEnd {
public:
    ShadowRayEnd(const Scene& scene, const Ray& ray, Vec3 p, const LightLiSample& light_sample);
    /// Returns the end of the ray or, for a surface light, a point just behind the light. If nothing is hit before it,
    /// the light is visible.
    const Hit& conservative() const { return end_; }
    /// Returns the end at the light's exact distance along the ray.
    Hit exact(const Ray& ray) const;
    bool is_surface() const { return light_ != nullptr; }
    /// Returns whether the light is a flat surface. exact() then returns the ray's own hit on the light, if there is
    /// one.
    bool is_flat() const { return is_surface() && !std::holds_alternative<Sphere>(light_->shape); }

private:
    const SurfaceLight* light_ = nullptr;
    float sampled_distance_;
    Hit end_;
};

/// Returns whether the light is visible from the vertex. This counts as one shadow ray.
bool unoccluded(const RenderPlan& plan, const Ray& ray, const ShadowRayEnd& end); ///< `ray` leads to `end`
template <typename AnyVertex>
inline bool unoccluded(const RenderPlan& plan, const AnyVertex& vertex, const LightLiSample& light_sample) {
    const Ray ray = spawn_ray(plan, vertex, light_sample.wi);
    return unoccluded(plan, ray, ShadowRayEnd(plan.scene, ray, light_receiver(vertex).p, light_sample));
}

/// Returns the density by solid angle with which sample_li draws the direction to `point`, which is on an emissive
/// surface. It is 0 if the surface is not sampled as a light (it moves, or does not emit toward the receiver).
float pdf_li(const Scene& scene, const LightSampler& lights, const LightReceiver& receiver, const SurfacePoint& point);
/// Returns the density by solid angle with which sample_li draws the direction w to the environment.
float pdf_li(const Environment& environment, const LightSampler& lights, const LightReceiver& receiver, Vec3 w);

} // namespace duet::raytrace

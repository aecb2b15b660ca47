// Declares light emission, which starts paths at the lights: it draws a light, a point on it and a direction
// (Physically Based Rendering, 3rd edition, §16.1.2).
#pragma once

#include "common/sampling/distribution.h"
#include "raytrace/render_plan.h"

namespace duet::raytrace {

/// Holds the random samples in [0, 1) of an emitted ray.
struct EmissionRandomSamples {
    float choice;
    Vec2 position, direction;
};

/// Holds the density of an emitted ray. For a surface light it is the density by area and by the solid angle of the
/// direction, for a point or spot light the density by solid angle, and for a sun or the environment the density by
/// area across the ray and (for the environment) by solid angle. It includes the probability of the light, and is 0 for
/// rays that are never emitted.
struct EmissionDensity {
    double density = 0;
    /// This factor converts a density by solid angle at a receiver to the measure of `density` at the light. It is |cos
    /// θ| at a surface light, the squared distance to a point or spot light, and 1 at infinity.
    double geometry = 1;
};

/// Holds a ray that a light emits.
struct EmittedRay {
    Ray ray;
    std::size_t light = 0; ///< index of the light; see LightSampler
    Vec3 position;         ///< point on the light, from which the ray's origin is offset
    Rgb weight;            ///< emitted radiance times cosine, or intensity or irradiance, over the density
};

/// Draws rays from the lights that the plan samples, in proportion to their power. Only the part of the environment
/// that is sampled as a light emits rays (see environment.h).
class LightEmission {
public:
    explicit LightEmission(const RenderPlan& plan);

    /// Returns whether no light emits rays.
    bool empty() const { return choice_.size() == 0 || choice_.integral() == 0; }
    /// Returns whether emitted rays can find all light of the scene. If not, only paths from the camera find some of
    /// it: uniform light of the environment, or emitters without a Light (they move, or are ellipsoids).
    bool complete() const { return complete_; }
    /// Draws a ray at the given time. Returns nothing if the sample is degenerate.
    std::optional<EmittedRay> sample(const EmissionRandomSamples& u, float time) const;
    /// Returns the density with which sample() draws the ray from the light's point q in the unit direction w, which
    /// reaches the point p. For lights at infinity only w matters. For a point or spot light, q is its position.
    EmissionDensity density(std::size_t light, Vec3 q, Vec3 w, Vec3 p) const;
    /// Returns the fraction of the environment's light from direction w that photons carry in photon mapping. The rest
    /// is left to paths from the camera, which find uniform light better. Without this division, the weight of a photon
    /// would be unbounded in directions where the environment is hardly brighter than its part that is not sampled.
    double photon_fraction(Vec3 w) const;
    /// Returns whether the light comes from a single position or direction, so that no other ray can hit it.
    bool is_delta(std::size_t light) const;

private:
    const RenderPlan& plan_;
    Vec3 center_; ///< center of the scene's bounding sphere, which rays from infinity enter
    double radius_;
    Distribution1D choice_; ///< indexed by light; the environment comes last
    bool complete_;
};

} // namespace duet::raytrace

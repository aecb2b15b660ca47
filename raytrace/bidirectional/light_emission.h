// Light emission starts paths at the lights: it draws a light, a point on it and a direction (Physically Based
// Rendering, 3rd edition, §16.1.2).
#pragma once

#include "common/sampling/distribution.h"
#include "raytrace/render_plan.h"

namespace duet::raytrace {

/// Holds the random samples in [0, 1) of an emitted ray.
struct EmissionRandomSamples {
    float choice;
    Vec2 position, direction;
};

/// Holds the density of an emitted ray: by the area of the light and the solid angle of the direction; of a light at
/// one position, by solid angle; of a light at infinity, by solid angle (of the environment) and area across the ray.
/// It includes the choice of the light, and is 0 for rays that are never emitted.
struct EmissionDensity {
    double density = 0;
    /// This factor turns a density by solid angle at a receiver into the one that `density` has at the light's end:
    /// |cos θ| at a surface light, the squared distance to a light at one position, and 1 at infinity.
    double geometry = 1;
};

/// Holds a ray that a light emits.
struct EmittedRay {
    Ray ray;
    std::size_t light = 0; ///< see LightSampler
    Vec3 position;         ///< on the light; the ray's origin is offset from it
    Rgb weight;            ///< emitted radiance times cosine, or intensity or irradiance, over the density
};

/// Draws rays from the lights that the plan samples, in proportion to their power. The environment emits as far as it
/// is sampled (see environment.h).
class LightEmission {
public:
    explicit LightEmission(const RenderPlan& plan);

    /// Returns whether no light emits rays.
    bool empty() const { return choice_.size() == 0 || choice_.integral() == 0; }
    /// Returns whether all light of the scene is emitted. Else only paths from the camera find some of it: even light
    /// of the environment, or emitters without a Light (they move, or are ellipsoids).
    bool complete() const { return complete_; }
    /// Draws a ray at the time `time`. Returns nothing where the sample is degenerate.
    std::optional<EmittedRay> sample(const EmissionRandomSamples& u, float time) const;
    /// Returns the density with which sample() draws the ray from the light's point q in the unit direction w, which
    /// reaches the point p. At infinity only w counts, and at a light of one position, q is that position.
    EmissionDensity density(std::size_t light, Vec3 q, Vec3 w, Vec3 p) const;
    /// Returns the fraction of the environment's light from direction w that photons carry in photon mapping. The rest
    /// is left to paths from the camera, which find even light better. Without it, the weight of a photon would have
    /// no bound where the environment is hardly brighter than what is not sampled.
    double photon_fraction(Vec3 w) const;
    /// Returns whether the light shines from one position or direction, which no other ray finds.
    bool is_delta(std::size_t light) const;

private:
    const RenderPlan& plan_;
    Vec3 center_; ///< of the sphere around the scene, through which rays from infinity pass
    double radius_;
    Distribution1D choice_; ///< by light, and for the environment
    bool complete_;
};

} // namespace duet::raytrace

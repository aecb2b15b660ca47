// Where a path is scattered inside of media, and where along a ray to look for light that they scatter.
#pragma once

#include "common/medium/medium.h"
#include "raytrace/integrator/medium_vertex.h"

#include <optional>
#include <span>

namespace duet::raytrace {

/// A MediumCollision is a point of a ray at which a medium scatters a path.
struct MediumCollision {
    float t = 0;
    float asymmetry = 0; ///< that of the medium
};
/// Follows a path along [0, t_end] of its ray. Returns where a medium scatters it, or nothing if it arrives at t_end.
/// `throughput` is multiplied by the transmittance and, at a collision, by the coefficient of scattering, divided by
/// the density of this outcome. `emitted` is increased by what the media emit on the way, times the throughput. The
/// distance is decided by u in [0, 1).
///
/// All channels share one path, even if a medium scatters them differently. Distances are drawn for the channel that
/// scatters most. Such a tentative collision is then accepted with a probability that depends on the throughput, so
/// that weights stay bounded (Kutz et al. 2017, "Spectral and Decomposition Tracking for Rendering Heterogeneous
/// Volumes", §4). Absorption and emission are integrated in closed form.
std::optional<MediumCollision> sample_collision(std::span<const Medium> media, const Ray& ray, float t_end, float u,
                                                Rgb& throughput, Rgb& emitted);

/// A ScatteredLight is light of a delta light that media scatter back along a ray.
struct ScatteredLight {
    MediumVertex vertex; ///< where it is scattered
    LightLiSample light;
    Rgb radiance; ///< what arrives at the begin of the ray over the density of the sample, unless light is occluded
};
/// Samples the light of the plan's delta lights that media scatter on [0, t_end] of the ray. u in [0, 1)² chooses the
/// distance and the light. Returns nothing if the sample is dark.
std::optional<ScatteredLight> sample_scattered_light(const RenderPlan& plan, const Ray& ray, float t_end, Vec2 u);

/// Draws the distance along a ray at which the light of a delta light is scattered. For a point or spot light, one half
/// of the samples have a density in proportion to 1 / (distance to the light)², which cancels the falloff of its light
/// (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media", §4: equi-angular
/// sampling). The density of all others falls like the transmittance.
class ScatteringDistance {
public:
    /// For a sun. The distances lie in `range`, which must not be empty. `extinction` is σs + σa at its begin, > 0.
    ScatteringDistance(Interval range, float extinction);
    /// For a light at a point. The ray's direction has unit length; `extinction` may be 0.
    ScatteringDistance(const Ray& ray, Vec3 light, Interval range, float extinction);
    /// Returns a distance t of the range, for u in [0, 1).
    float sample(float u) const;
    /// Returns the density by distance at a t of the range.
    float pdf(float t) const;
    /// Returns how much light arrives on the range per unit of intensity or irradiance, by the roughest estimate: the
    /// integral of 1 / (distance to the light)² or, for a sun, the length that it lights.
    float integral() const;

private:
    float sample_angle(float u) const;
    float sample_transmittance(float u) const;

    Interval range_;
    float extinction_, scattered_; ///< `scattered_` is 1 − exp(−extinction · length)
    float share_of_angles_ = 0;    ///< share of the samples that cancel the falloff
    float height_ = 0;             ///< distance of the light from the ray's line, > 0
    float begin_ = 0;              ///< the begin of the range, from where the line is nearest to the light
    float angle_ = 0;              ///< angle between both ends of the range, seen from the light
};

} // namespace duet::raytrace

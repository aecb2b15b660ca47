// Samples the light of point, spot and sun lights that media scatter toward a path, along a whole ray.
#pragma once

#include "raytrace/integrator/media_on_ray.h"
#include "raytrace/integrator/medium_vertex.h"

#include <array>
#include <optional>

namespace duet::raytrace {

/// Represents light of a delta light that media scatter back along a ray.
struct ScatteredLight {
    MediumVertex vertex; ///< point at which the light is scattered
    LightLiSample light;
    Rgb radiance; ///< radiance at the ray's origin over the sample's density, without occlusion
};
/// Samples the light of the plan's delta lights that media scatter along a ray. u in [0, 1)² chooses the distance and
/// the light. Returns nothing if no light arrives.
std::optional<ScatteredLight> sample_scattered_light(const RenderPlan& plan, MediaOnRay& media, Vec2 u);

/// Draws a distance along a ray with a density in proportion to 1 / (distance to a light)², which cancels the falloff
/// of its light (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media", §4).
class EquiangularDistance {
public:
    /// The range must not be empty. It may be infinite. The ray's direction has unit length.
    EquiangularDistance(const Ray& ray, Interval range, Vec3 light);
    float sample(float u) const; ///< for u in [0, 1)
    float pdf(float t) const;    ///< for t in the range
    /// Returns the integral of 1 / (distance to the light)², 1/m.
    float integral() const { return angle_ / height_; }

private:
    Interval range_;
    float height_ = 0; ///< distance of the light from the ray's line, > 0
    float begin_ = 0;  ///< signed distance from the point nearest to the light to the range's begin
    float angle_ = 0;  ///< angle between both ends of the range, seen from the light
};

/// Describes a point of a ray at which light may be scattered, by the media up to it.
struct PointOnRay {
    float pdf = 0;     ///< density by distance with which the point is drawn
    Rgb transmittance; ///< transmittance of the media up to the point
};

/// Draws a distance along a ray at which scattering media stop light. The density is that of collisions with one medium
/// in one channel, chosen by the fraction of light that the medium alone would stop on the range. A medium that stops
/// nearly all light is treated as infinitely long, so that it need not be followed to its end. A sample behind its end
/// is discarded.
class StoppedDistance {
public:
    /// Keeps a reference to the media.
    StoppedDistance(MediaOnRay& media, Interval range);
    bool possible() const { return stopped_ > 0; } ///< whether media stop any light on the range
    float sample(float u);                         ///< for u in [0, 1); infinite if the sample is discarded
    PointOnRay at(float t);                        ///< for t in the range
    /// Returns the approximate length of the range that distant light reaches from the side: the range without its part
    /// behind dense media.
    float lit_length() const { return lit_length_; }

private:
    Interval inside(const MediumOnRay& medium) const;

    MediaOnRay& media_;
    Interval range_;
    std::array<Rgb, kMaxMedia> shares_; ///< fraction of light that each medium would stop, by channel
    float stopped_ = 0;                 ///< sum of shares_
    float lit_length_ = 0;
};

/// Draws the distance along a ray at which the light of a delta light is scattered. It samples where media stop light.
/// For a point or spot light, one half of the samples is equiangular instead.
class ScatteringDistance {
public:
    /// Keeps references to both arguments.
    ScatteringDistance(StoppedDistance& stopped, const std::optional<EquiangularDistance>& angle)
        : stopped_(stopped), angle_(angle) {}
    /// Returns a distance t in the range, for u in [0, 1), or infinity if the sample is discarded. Media must stop some
    /// light in the range.
    float sample(float u);
    PointOnRay at(float t); ///< for t in the range

private:
    StoppedDistance& stopped_;
    const std::optional<EquiangularDistance>& angle_;
};

} // namespace duet::raytrace

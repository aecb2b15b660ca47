// Light of points and suns that media scatter towards a path, looked for along a whole ray.
#pragma once

#include "raytrace/integrator/media_on_ray.h"
#include "raytrace/integrator/medium_vertex.h"

#include <array>
#include <optional>

namespace duet::raytrace {

/// A ScatteredLight is light of a delta light that media scatter back along a ray.
struct ScatteredLight {
    MediumVertex vertex; ///< where it is scattered
    LightLiSample light;
    Rgb radiance; ///< what arrives at the begin of the ray over the density of the sample, unless light is occluded
};
/// Samples the light of the plan's delta lights that media scatter along a ray. u in [0, 1)² chooses the distance and
/// the light. Returns nothing if the sample is dark.
std::optional<ScatteredLight> sample_scattered_light(const RenderPlan& plan, MediaOnRay& media, Vec2 u);

/// Draws a distance along a ray with a density in proportion to 1 / (distance to a light)², which cancels the falloff
/// of its light (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media", §4).
class EquiangularDistance {
public:
    /// The range must not be empty. It may be infinite. The ray's direction has unit length.
    EquiangularDistance(const Ray& ray, Interval range, Vec3 light);
    float sample(float u) const; ///< for u in [0, 1)
    float pdf(float t) const;    ///< for a t of the range
    /// Returns the integral of 1 / (distance to the light)², 1/m.
    float integral() const { return angle_ / height_; }

private:
    Interval range_;
    float height_ = 0; ///< distance of the light from the ray's line, > 0
    float begin_ = 0;  ///< the begin of the range, from where the line is nearest to the light
    float angle_ = 0;  ///< angle between both ends of the range, seen from the light
};

/// Holds what a ray has passed up to a point at which light may be scattered.
struct PointOnRay {
    float pdf = 0;     ///< density by distance with which the point is drawn
    Rgb transmittance; ///< of the media before it
};

/// Draws a distance along a ray at which media that scatter stop light: with the density of collisions of one of them
/// in one channel, chosen by how much light it would stop on the range alone. A medium that stops nearly all counts as
/// if it never ended, so that it is not followed to its end. Then a sample may lie behind its end, and is none.
class StoppedDistance {
public:
    /// Keeps a reference to the media.
    StoppedDistance(MediaOnRay& media, Interval range);
    bool possible() const { return stopped_ > 0; } ///< whether media stop any light on the range
    float sample(float u);                         ///< for u in [0, 1); infinite if there is none
    PointOnRay at(float t);                        ///< for a t of the range
    /// Returns the length that a light lights from aside, roughly: that of the range, less what lies behind dense
    /// media.
    float lit_length() const { return lit_length_; }

private:
    Interval inside(const MediumOnRay& medium) const;

    MediaOnRay& media_;
    Interval range_;
    std::array<Rgb, kMaxMedia> shares_; ///< by channel, the fraction of light that each medium would stop
    float stopped_ = 0;                 ///< their sum
    float lit_length_ = 0;
};

/// Draws the distance along a ray at which the light of a delta light is scattered: where media stop light, and for a
/// light at a point with one half of the samples by the angle that it sees.
class ScatteringDistance {
public:
    /// Keeps references to both.
    ScatteringDistance(StoppedDistance& stopped, const std::optional<EquiangularDistance>& angle)
        : stopped_(stopped), angle_(angle) {}
    /// Returns a distance t of the range, for u in [0, 1), or infinity for no sample. Media must stop some light there.
    float sample(float u);
    PointOnRay at(float t); ///< for a t of the range

private:
    StoppedDistance& stopped_;
    const std::optional<EquiangularDistance>& angle_;
};

} // namespace duet::raytrace

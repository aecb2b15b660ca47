// Samples where media scatter a path, and what they emit along its ray.
#pragma once

#include "raytrace/integrator/media_on_ray.h"

#include <optional>
#include <span>

namespace duet::raytrace {

/// Represents a point of a ray at which a medium scatters a path.
struct MediumCollision {
    float t = 0;
    float asymmetry = 0; ///< asymmetry of the medium's phase function
};
/// Follows a path along its ray. Returns where a medium scatters it, or nothing if it arrives at the ray's end.
/// `throughput` is multiplied by the transmittance and, at a collision, by the scattering coefficient, divided by the
/// density of this outcome. `emitted` is increased by the mean light that the media emit on the way, times the
/// throughput. The outcome is decided by u in [0, 1).
///
/// Each medium draws the optical depth at which it would scatter the path if it were alone; the path is scattered at
/// the first of these collisions. Depths are found by integration along the ray (regular tracking), so that no null
/// collisions are needed. All channels share one path, even if a medium scatters them differently: depths are drawn for
/// a channel that is chosen in proportion to the throughput, and the density is the mean over that choice, so that
/// weights stay bounded (Wilkie et al. 2014, "Hero Wavelength Spectral Sampling"). Absorption only changes the weight.
std::optional<MediumCollision> sample_collision(MediaOnRay& media, float u, Rgb& throughput, Rgb& emitted);

/// Returns an unbiased estimate of the transmittance of the media on [0, t_end] of a ray. It is exact for media of
/// uniform density. In deep clouds, below a transmittance of 5 %, Russian roulette decides by u in [0, 1) whether the
/// light arrives.
Rgb estimate_transmittance(std::span<const Medium> media, const Ray& ray, float t_end, float u);

} // namespace duet::raytrace

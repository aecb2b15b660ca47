// Surfaces that emit a picture: their mean, by which lights are chosen, and their radiance at a point.
#pragma once

#include "common/scene/scene.h"

namespace duet {

/// The radiance of an emissive primitive of a scene's object, averaged over its area (up to the picture's detail within
/// 1/64 of it; equal areas by uv). Of one without a texture its radiance.
Rgb mean_radiance(const Scene& scene, std::uint32_t object, std::uint32_t primitive, const Emissive& lamp);

/// The radiance that leaves a light's surface back along a ray from p (direction w, unit) that meets it at `distance`.
/// The light's mean radiance where it has no texture, and where the ray misses it by a rounding.
Rgb radiance_towards(const Scene& scene, const SurfaceLight& light, Vec3 p, Vec3 w, float distance);

} // namespace duet

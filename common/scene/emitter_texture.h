// This file evaluates emitters with a radiance texture: their mean radiance, which the choice among lights uses, and
// their radiance at a point.
#pragma once

#include "common/scene/scene.h"

namespace duet {

/// Returns the radiance of an emissive primitive of a scene's object, averaged over its area at 64 points, each
/// filtered over its cell of equal area in uv. Without a texture it is the emitter's radiance.
Rgb mean_radiance(const Scene& scene, std::uint32_t object, std::uint32_t primitive, const Emissive& emissive);

/// Returns the radiance that a light emits back along the ray from p in direction w (unit), which hits it at
/// `distance`. Where the light has no texture, or where the ray misses it because of rounding, this is the light's
/// mean radiance.
Rgb radiance_toward(const Scene& scene, const SurfaceLight& light, Vec3 p, Vec3 w, float distance);

} // namespace duet

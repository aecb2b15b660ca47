// This file handles rays that pass through surfaces with an alpha mask or alpha blending.
#pragma once

#include "common/scene/scene.h"

namespace duet {

/// Returns whether a ray passes straight through the surface that it hits. It always passes where the opacity is 0
/// and never where it is 1. In between it passes with probability 1 − opacity, by a random number that is a hash of
/// the ray and the primitive. The mean over rays equals alpha blending, and the same ray gives the same result in
/// both pipelines.
bool passes_alpha_mask(const Scene& scene, const Ray& ray, const Hit& hit);

/// Returns whether rays may pass through an object: whether any of its materials has an opacity below 1.
bool can_be_seen_through(const Scene& scene, const Object& object);

} // namespace duet

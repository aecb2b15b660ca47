// Rays that go through surfaces, by their opacity.
#pragma once

#include "common/scene/scene.h"

namespace duet {

/// Whether a ray goes straight on through what it hits: always through a hole, never through a whole surface, and in
/// between for the part of rays that the surface lets through, by a number that is a hash of the ray and the primitive.
/// So the mean over rays is that of blending, and the same ray always does the same, in both
/// pipelines.
bool passes_through(const Scene& scene, const Ray& ray, const Hit& hit);

} // namespace duet

// Rays that run anywhere, through a hierarchy of few nodes side by side: a ray alone waits at every box for what the
// last comparison says, and the processor guesses wrong where it goes. Here each step is done for all rays before the
// next one is, from lists that are written without a branch (like the ray streams of Tsakok 2009, «Faster Incoherent
// Rays: Multi-BVH Ray Stream Tracing»).
#pragma once

#include "common/geometry/hit.h"
#include "common/vec/ray.h"
#include "raytrace/acceleration/bvh.h"

#include <span>

namespace duet::raytrace {

/// Whether rays that run anywhere are sooner through a hierarchy together: a tree of few nodes, of whose leaves most hold
/// spheres and none instances, and of which a ray is expected to meet few, as no ray of a stream visits what is near
/// first. Only where the machine can write lists without a branch: on AVX2, where streams were tried, they take as long as
/// the rays one by one or up to 1.9 times as long.
bool streamable(const Bvh& bvh);

/// Fewer rays than this are sooner there one by one. (spheres.json, Zen 5, times as long as these: 1 ray 2.6, 2 rays 1.45,
/// 3 rays 1.07, 4 rays 0.94, 5 rays 0.86, 8 rays 0.72, 64 rays 0.65.)
inline constexpr std::size_t kFewestStreamed = 4;

/// Of the rays with these indices, through a streamable hierarchy: finds what `find_closest` finds for each, to the bit,
/// and leaves it at the same index.
void find_closest_of_stream(const Bvh& bvh, std::span<const Ray> rays, std::span<const std::uint32_t> which,
                            std::span<Hit> hits);

} // namespace duet::raytrace

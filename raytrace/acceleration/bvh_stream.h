// A stream of incoherent rays traverses a hierarchy of few nodes. A single ray stalls at every box until the last
// comparison is done, and its branches are mispredicted. A stream does each step for all rays before the next step,
// with lists that are written without a branch (like the ray streams of Tsakok 2009, "Faster Incoherent Rays:
// Multi-BVH Ray Stream Tracing").
#pragma once

#include "common/geometry/hit.h"
#include "common/vec/ray.h"
#include "raytrace/acceleration/bvh.h"

#include <span>

namespace duet::raytrace {

/// Returns whether incoherent rays traverse a hierarchy faster as a stream than one by one. The tree must have few
/// nodes and no instances, most of its blocks must hold spheres, and a ray must be expected to visit few leaves,
/// since a stream does not visit the nearest first. This needs AVX-512, which can write lists without a branch. On
/// AVX2, where streams were tried, they take 1 to 1.9 times as long as single rays.
bool streamable(const Bvh& bvh);

/// Fewer rays than this are faster one by one. (Time of a stream relative to single rays, spheres.json, Zen 5: 1 ray
/// 2.6, 2 rays 1.45, 3 rays 1.07, 4 rays 0.94, 5 rays 0.86, 8 rays 0.72, 64 rays 0.65.)
inline constexpr std::size_t kMinStreamSize = 4;

/// Finds the closest hits of the rays with the indices `indices`, bit-equal to those of `find_closest`, and writes
/// them to `hits` at the same indices. The hierarchy must be streamable.
void find_closest_of_stream(const Bvh& bvh, std::span<const Ray> rays, std::span<const std::uint32_t> indices,
                            std::span<Hit> hits);

} // namespace duet::raytrace

// This file defines a tracer: a ray kernel, Duet's or a peer's, that traces one set of rays.
#pragma once

#include "common/vec/ray.h"
#include "raytrace/acceleration/accelerator.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds a kernel's result for one ray: the distance and triangle of the closest hit; for a shadow ray, only whether it
/// is blocked.
struct RayResult {
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    float t = std::numeric_limits<float>::infinity();
    std::uint32_t triangle = kNone; ///< index in its object's mesh; 0 for a blocked shadow ray
    std::uint32_t object = 0;

    bool hit() const { return triangle != kNone; }
};

/// Rays are traced in blocks of kBlock. Each block's results have their own cache lines, because false sharing between
/// threads would prevent scaling.
inline constexpr std::size_t kBlock = 256;
/// Holds the results of one block of rays.
struct alignas(64) RayResultBlock {
    std::array<RayResult, kBlock> ray_results;
};

/// Returns the number of blocks for a number of rays.
inline std::size_t block_count(std::size_t rays) { return (rays + kBlock - 1) / kBlock; }
/// Returns the rays of a block; the last one may have fewer than kBlock.
inline std::span<const Ray> block_of(std::span<const Ray> rays, std::size_t block) {
    return rays.subspan(block * kBlock, std::min(kBlock, rays.size() - block * kBlock));
}

/// A Tracer is a function that traces one block of the set; only this differs between kernels. It may be called from
/// any thread.
struct Tracer {
    std::string name; ///< "embree 3.13.5 medium packets 16"
    std::function<void(std::size_t block, RayResult* ray_results)> trace;
};

/// Returns a tracer for closest hits by the accelerator's public functions, called exactly as the path tracer
/// calls them. The rays and the accelerator must outlive the tracer.
Tracer duet_closest(const raytrace::Accelerator& accelerator, std::span<const Ray> rays);
/// This is the number of rays per call of duet_batched's tracer. It equals that of the path tracer's camera rays.
inline constexpr std::size_t kBatch = 64;
/// Returns a tracer for closest hits of kBatch rays at a time, by the accelerator's function for many rays.
Tracer duet_batched(const raytrace::Accelerator& accelerator, std::span<const Ray> rays);
/// Returns a tracer for occlusion. `ends` holds the light at the end of each ray, which does not block it
/// (`Accelerator::occluded`).
Tracer duet_occluded(const raytrace::Accelerator& accelerator, std::span<const Ray> rays, std::span<const Hit> ends);

/// Returns a tracer's results to all rays of a set, in order.
std::vector<RayResult> trace_all(const Tracer& tracer, std::size_t rays, int threads);

} // namespace duet::compare

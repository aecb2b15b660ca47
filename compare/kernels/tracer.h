// A ray kernel at work on one set of rays: ours, or a peer's.
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

/// What a kernel says of a ray: the distance and the triangle it hits first; of a shadow ray just whether it hits.
struct Answer {
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    float t = std::numeric_limits<float>::infinity();
    std::uint32_t triangle = kNone; ///< of its object's mesh; a shadow ray that is blocked: 0
    std::uint32_t object = 0;

    bool hit() const { return triangle != kNone; }
};

/// Rays are traced in blocks of kBlock; each block's answers have cache lines of their own, or two threads would wait
/// for each other's writes and all scaling be lost.
inline constexpr std::size_t kBlock = 256;
struct alignas(64) AnswerBlock {
    std::array<Answer, kBlock> answers;
};

inline std::size_t block_count(std::size_t rays) { return (rays + kBlock - 1) / kBlock; }
inline std::span<const Ray> block_of(std::span<const Ray> rays, std::size_t block) {
    return rays.subspan(block * kBlock, std::min(kBlock, rays.size() - block * kBlock));
}

/// All that differs between kernels: how a block of the set is traced. Called from any thread.
struct Tracer {
    std::string name; ///< "embree 3.13.5 medium packets 16"
    std::function<void(std::size_t block, Answer* answers)> trace;
};

/// Our kernel through the accelerator's public functions, called just as the path tracer calls them. The rays and the
/// accelerator must outlive the tracer.
Tracer our_closest(const raytrace::Accelerator& accelerator, std::span<const Ray> rays);
/// kBatch rays at a time, as the path tracer has camera rays traced.
inline constexpr std::size_t kBatch = 64;
Tracer our_bulk(const raytrace::Accelerator& accelerator, std::span<const Ray> rays);
/// `ends`: what each ray is aimed at, which does not block it, as the path tracer has it (`Accelerator::occluded`).
Tracer our_occluded(const raytrace::Accelerator& accelerator, std::span<const Ray> rays, std::span<const Hit> ends);

/// A tracer's answers to all rays of a set, in their order.
std::vector<Answer> all_answers(const Tracer& tracer, std::size_t rays, int threads);

} // namespace duet::compare

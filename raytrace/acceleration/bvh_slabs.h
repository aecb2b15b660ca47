// Rays against the boxes of nodes: conservative, so that no box is skipped that holds a hit.
#pragma once

#include "common/system/sabotage.h"
#include "common/vec/ray.h"
#include "raytrace/acceleration/bvh.h"

#include <bit>

namespace duet::raytrace {

/// A ray made ready for box tests. Its slab distances are lower and upper bounds of the distances which the primitives'
/// tests compute: the origin is moved by more than the rounding of both tests, by the size of the whole hierarchy as
/// seen from there (Woop et al. have 5 roundings, the triangle's distance 6 more, and the fused form plane·(1/d) −
/// origin·(1/d) another of each; here is room for 16).
class SlabRay {
public:
    using Batch = FloatBatch<BvhNode::kWidth>;

    /// Of the sizes at hand, the room that boxes get.
    static float relative_error() { return sabotaged(Guard::kEnlargedBoxes) ? 0.0f : 0x1p-20f; }
    /// No reciprocal is infinite: a direction's component of 0 counts as this part of the largest, so small that the
    /// ray leaves a slab that it is in (by more than the error that the slab is widened by) beyond all that lies in the
    /// box.
    static constexpr float kSmallest = 1e-12f;
    /// And no product of a reciprocal with a coordinate is infinite: the fused form would take it for a plane.
    template <typename B> static B least_divisor(B coordinates) {
        return max(coordinates * B(0x1p-120f), B(0x1p-125f));
    }

    SlabRay() = default; // of no ray
    SlabRay(const Ray& ray, const Box3& bounds) {
        // Without a branch on signs or sizes, which incoherent rays would mispredict.
        using Four = FloatBatch<4>;
        const auto four = [](Vec3 v) { return Four(_mm_setr_ps(v.x, v.y, v.z, 0.0f)); };
        const float relative = relative_error();
        const Four origin = four(ray.origin), direction = four(ray.direction);
        const Four extent = xsimd::max(xsimd::abs(four(bounds.low) - origin), xsimd::abs(four(bounds.high) - origin));
        const Four sign = xsimd::bitwise_and(direction, Four(-0.0f)), size = xsimd::abs(direction);
        const Four error = (extent + extent + greatest(extent) + xsimd::abs(origin)) * Four(relative) +
                           Four(std::numeric_limits<float>::min());
        const Four divisor = xsimd::max(xsimd::max(size, greatest(size) * Four(kSmallest)),
                                        least_divisor(extent + xsimd::abs(origin)));
        const Four reciprocal = xsimd::bitwise_or(Four(1.0f) / divisor, sign);
        const Four away = xsimd::bitwise_or(error, sign);
        const Four near = -(origin + away) * reciprocal, far = -(origin - away) * reciprocal;
        reciprocal.store_aligned(scale_.data());
        near.store_aligned(near_offset_.data());
        far.store_aligned(far_offset_.data());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t high = std::bit_cast<std::uint32_t>(ray.direction[axis]) >> 31;
            near_plane_[axis] = kPlane * (axis + 3 * high);
            far_plane_[axis] = kPlane * (axis + 3 - 3 * high);
        }
    }

    /// Where the ray enters each child's box, and a bit for each that it does enter at a distance in [t_min, t_max].
    struct Entered {
        Batch distance;
        unsigned children;
    };
    Entered enter(const BvhNode& node, Batch t_min, Batch t_max) const {
        const auto slab = [&](std::size_t plane, float scale, float offset) {
            const auto* values = reinterpret_cast<const float*>(reinterpret_cast<const char*>(&node) + plane);
            return fused(Batch::load_aligned(values), Batch(scale), Batch(offset));
        };
        // A NaN (of numbers out of range) comes first in min and max, which then return the second: that slab does not
        // count.
        const Batch nx = slab(near_plane_[0], scale_[0], near_offset_[0]),
                    ny = slab(near_plane_[1], scale_[1], near_offset_[1]),
                    nz = slab(near_plane_[2], scale_[2], near_offset_[2]);
        const Batch fx = slab(far_plane_[0], scale_[0], far_offset_[0]),
                    fy = slab(far_plane_[1], scale_[1], far_offset_[1]),
                    fz = slab(far_plane_[2], scale_[2], far_offset_[2]);
        const Batch near = xsimd::max(xsimd::max(nx, ny), xsimd::max(nz, t_min));
        const Batch far = xsimd::min(xsimd::min(fx, fy), xsimd::min(fz, t_max));
        return {near, lane_bits(near <= far)};
    }

private:
    /// The greatest lane, in all of them.
    static FloatBatch<4> greatest(FloatBatch<4> v) {
        const FloatBatch<4> twos = xsimd::max(v, FloatBatch<4>(_mm_shuffle_ps(v, v, _MM_SHUFFLE(1, 0, 3, 2))));
        return xsimd::max(twos, FloatBatch<4>(_mm_shuffle_ps(twos, twos, _MM_SHUFFLE(2, 3, 0, 1))));
    }

    static constexpr std::size_t kPlane = sizeof(BvhNode::Lanes);
    std::array<std::size_t, 3> near_plane_, far_plane_; // in bytes from the node
    alignas(16) std::array<float, 4> scale_, near_offset_, far_offset_; // x, y, z and one too many
};

} // namespace duet::raytrace

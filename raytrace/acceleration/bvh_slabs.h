// Implements the ray-box tests of nodes. They are conservative: no box that contains a hit is skipped.
#pragma once

#include "common/vec/ray.h"
#include "raytrace/acceleration/bvh.h"

#include <bit>

namespace duet::raytrace {

/// Defines error bounds that make box tests conservative: slab distances are lower and upper bounds of the distances
/// that the tests of primitives compute. The origin is moved by more than the rounding of both tests, in proportion to
/// the size of the whole hierarchy as seen from there. (Woop et al. count 5 roundings, the triangle's distance has 6
/// more, the form plane·(1/d) − origin·(1/d) adds another to each of the two tests, and its first product is rounded,
/// too, if the CPU lacks fused multiply-add; this bound has room for 16.)
struct SlabError {
    /// This is the margin of box tests, relative to the sizes of the coordinates.
    static constexpr float kRelative = 0x1p-20f;
    /// No reciprocal is infinite: a direction component of 0 is replaced by this fraction of the largest component. The
    /// fraction is so small that a ray leaves a slab beyond everything in the box, if its origin is inside the slab by
    /// more than the error bound.
    static constexpr float kSmallest = 1e-12f;

    /// Returns the distance by which the origin is moved along one axis. `extent` is the largest distance along this
    /// axis from the origin to the hierarchy's bounds, `greatest_extent` the largest over all three axes, and
    /// `magnitude` the absolute coordinate of the origin.
    template <typename B> static B shift(B extent, B greatest_extent, B magnitude) {
        return (extent + extent + greatest_extent + magnitude) * B(kRelative) + B(std::numeric_limits<float>::min());
    }
    /// Returns the number whose reciprocal scales distances along one axis. `size` is the absolute component of the
    /// direction, and `greatest_size` the largest over all three axes. It is so large that no product of the
    /// reciprocal with `coordinates` overflows, because infinity would be mistaken for the distance of a plane.
    template <typename B> static B divisor(B size, B greatest_size, B coordinates) {
        return max(max(size, greatest_size * B(kSmallest)), max(coordinates * B(0x1p-120f), B(0x1p-125f)));
    }
};

/// Prepares a ray for box tests.
class SlabRay {
public:
    using Batch = FloatBatch<BvhNode::kWidth>;

    SlabRay(const Ray& ray, const Box3& bounds) {
        // This code avoids branches on signs and sizes, which are mispredicted for incoherent rays.
        using Float4 = FloatBatch<4>;
        const auto to_float4 = [](Vec3 v) { return Float4(_mm_setr_ps(v.x, v.y, v.z, 0.0f)); };
        const Float4 origin = to_float4(ray.origin), direction = to_float4(ray.direction);
        const Float4 extent =
            xsimd::max(xsimd::abs(to_float4(bounds.low) - origin), xsimd::abs(to_float4(bounds.high) - origin));
        const Float4 sign = xsimd::bitwise_and(direction, Float4(-0.0f)), size = xsimd::abs(direction),
                     magnitude = xsimd::abs(origin);
        const Float4 shift = xsimd::bitwise_or(SlabError::shift(extent, greatest(extent), magnitude), sign);
        const Float4 divisor = SlabError::divisor(size, greatest(size), extent + magnitude);
        const Float4 scale = xsimd::bitwise_or(Float4(1.0f) / divisor, sign);
        const Lanes scales(scale), nears(-(origin + shift) * scale), fars(-(origin - shift) * scale);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t high = std::bit_cast<std::uint32_t>(ray.direction[axis]) >> 31;
            near_plane_[axis] = kPlane * (axis + 3 * high);
            far_plane_[axis] = kPlane * (axis + 3 - 3 * high);
            scale_[axis] = Batch(scales[axis]);
            near_offset_[axis] = Batch(nears[axis]);
            far_offset_[axis] = Batch(fars[axis]);
        }
    }

    /// Holds the distance at which the ray enters each child's box, and a bit mask of the children that it enters at
    /// a distance in [t_min, t_max].
    struct Entered {
        Batch distance;
        unsigned children;
    };
    Entered enter(const BvhNode& node, Batch t_min, Batch t_max) const {
        const auto slab = [&](std::size_t plane, Batch scale, Batch offset) {
            return multiply_add(Batch::load_aligned(node.plane(plane)), scale, offset);
        };
        // NaN, which results from values out of range, is the first argument of min and max. They then return the
        // second argument, so that this slab is ignored.
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
    /// Returns the largest lane, broadcast to all lanes.
    static FloatBatch<4> greatest(FloatBatch<4> v) {
        const FloatBatch<4> twos = xsimd::max(v, FloatBatch<4>(_mm_shuffle_ps(v, v, _MM_SHUFFLE(1, 0, 3, 2))));
        return xsimd::max(twos, FloatBatch<4>(_mm_shuffle_ps(twos, twos, _MM_SHUFFLE(2, 3, 0, 1))));
    }

    static constexpr std::size_t kPlane = sizeof(BvhNode::Lanes);
    std::array<std::size_t, 3> near_plane_, far_plane_; // offsets in bytes from the node
    /// A ray enters a slab through a plane at plane·scale + near_offset or later, and leaves it through a plane at
    /// plane·scale + far_offset or earlier.
    std::array<Batch, 3> scale_, near_offset_, far_offset_;
};

} // namespace duet::raytrace

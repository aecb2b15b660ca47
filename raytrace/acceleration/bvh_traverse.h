// Sending a ray through a hierarchy: near children first, whatever lies beyond the nearest hit is skipped.
//
// The answer is that of testing every primitive, to the bit, ties included: boxes are tested so conservatively that
// none is skipped that holds a hit (Woop, Benthin and Wald 2013, «Watertight Ray/Triangle Intersection», §3.3), and
// what is as near as the nearest hit is still looked at.
#pragma once

#include "common/geometry/hit.h"
#include "common/geometry/quad.h"
#include "common/geometry/sphere.h"
#include "common/geometry/triangle.h"
#include "common/system/sabotage.h"
#include "raytrace/acceleration/bvh.h"

#include <bit>
#include <cmath>

namespace duet::raytrace {

/// The order of hits along a ray: by distance, and at equal distance by (object, primitive).
inline bool precedes(const Hit& a, const Hit& b) {
    if (a.t != b.t || sabotaged(Guard::kTieOrder)) return a.t < b.t;
    return a.object != b.object ? a.object < b.object : a.primitive < b.primitive;
}

/// A ray made ready for box tests. Its slab distances are lower and upper bounds of the distances which the primitives'
/// tests compute: the origin is moved by more than the rounding of both tests, by the size of the whole hierarchy as
/// seen from there (Woop et al. have 5 roundings, the triangle's distance 6 more, and the fused form plane·(1/d) −
/// origin·(1/d) another of each; here is room for 16).
class SlabRay {
public:
    using Batch = FloatBatch<BvhNode::kWidth>;

    SlabRay(const Ray& ray, const Box3& bounds) {
        // Without a branch on signs or sizes, which incoherent rays would mispredict.
        using Four = FloatBatch<4>;
        const auto four = [](Vec3 v) { return Four(_mm_setr_ps(v.x, v.y, v.z, 0.0f)); };
        const float relative = sabotaged(Guard::kEnlargedBoxes) ? 0.0f : 0x1p-20f;
        // No reciprocal is infinite: a direction's component of 0 counts as one so small that the ray leaves a slab
        // that it is in (by more than the error that the slab is widened by) beyond all that lies in the box.
        constexpr float kSmallest = 1e-12f;
        const Four origin = four(ray.origin), direction = four(ray.direction);
        const Four extent = xsimd::max(xsimd::abs(four(bounds.low) - origin), xsimd::abs(four(bounds.high) - origin));
        const Vec3 size = abs(ray.direction);
        const Four sign = xsimd::bitwise_and(direction, Four(-0.0f));
        const Vec3 extents = max(abs(bounds.low - ray.origin), abs(bounds.high - ray.origin));
        const Four largest(max_component(extents));
        const Four error = (extent + extent + largest + xsimd::abs(origin)) * Four(relative) + Four(std::numeric_limits<float>::min());
        const Four divisor = xsimd::max(xsimd::abs(direction), Four(kSmallest * max_component(size)));
        const Four reciprocal = xsimd::bitwise_or(Four(1.0f) / divisor, sign);
        const Four away = xsimd::bitwise_or(error, sign);
        const Four near = -(origin + away) * reciprocal, far = -(origin - away) * reciprocal;
        alignas(16) std::array<float, 4> scales, nears, fars;
        reciprocal.store_aligned(scales.data());
        near.store_aligned(nears.data());
        far.store_aligned(fars.data());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t high = std::bit_cast<std::uint32_t>(ray.direction[axis]) >> 31;
            near_plane_[axis] = kPlane * (axis + 3 * high);
            far_plane_[axis] = kPlane * (axis + 3 - 3 * high);
            scale_[axis] = Batch(scales[axis]);
            near_offset_[axis] = Batch(nears[axis]);
            far_offset_[axis] = Batch(fars[axis]);
        }
    }

    /// Where the ray enters each child's box, and a bit for each that it does enter at a distance in [t_min, t_max].
    struct Entered {
        Batch distance;
        unsigned children;
    };
    Entered enter(const BvhNode& node, Batch t_min, Batch t_max) const {
        const auto slab = [&](std::size_t plane, Batch scale, Batch offset) {
            const auto* values = reinterpret_cast<const float*>(reinterpret_cast<const char*>(&node) + plane);
            return xsimd::fma(Batch::load_aligned(values), scale, offset);
        };
        // A NaN (of numbers out of range) comes first in min and max, which then return the second: that slab does not
        // count.
        const Batch nx = slab(near_plane_[0], scale_[0], near_offset_[0]), ny = slab(near_plane_[1], scale_[1], near_offset_[1]), nz = slab(near_plane_[2], scale_[2], near_offset_[2]);
        const Batch fx = slab(far_plane_[0], scale_[0], far_offset_[0]), fy = slab(far_plane_[1], scale_[1], far_offset_[1]), fz = slab(far_plane_[2], scale_[2], far_offset_[2]);
        const Batch near = xsimd::max(xsimd::max(nx, ny), xsimd::max(nz, t_min));
        const Batch far = xsimd::min(xsimd::min(fx, fy), xsimd::min(fz, t_max));
        return {near, lane_bits(near <= far)};
    }

private:
    static constexpr std::size_t kPlane = sizeof(BvhNode::Lanes);
    std::array<std::size_t, 3> near_plane_, far_plane_; // in bytes from the node
    std::array<Batch, 3> scale_, near_offset_, far_offset_;
};

inline const BvhNode& node_at(const Bvh& bvh, BvhRef ref) {
    return *reinterpret_cast<const BvhNode*>(reinterpret_cast<const char*>(bvh.nodes.data()) +
                                             std::size_t{ref.index()} * BvhRef::kNodeUnit);
}

/// Whether a ray can be traced: finite, with a direction. Others hit nothing.
inline bool traceable(const Ray& ray) {
    return is_finite(ray.origin) && is_finite(ray.direction) && max_component(abs(ray.direction)) > 0;
}

/// A child that waits to be visited: where the ray enters its box, and which it is. In one number, so that a stack of
/// them is written and sorted at least cost: distances that are not negative are ordered like their bits.
class Waiting {
public:
    Waiting() = default; // without a value: nobody should clear a stack of these for each ray
    Waiting(float entry, BvhRef child) : bits_(std::uint64_t{std::bit_cast<std::uint32_t>(entry)} << 32 | child.bits()) {}

    float entry() const { return std::bit_cast<float>(static_cast<std::uint32_t>(bits_ >> 32)); }
    BvhRef child() const { return BvhRef::from_bits(static_cast<std::uint32_t>(bits_)); }
    bool nearer_than(Waiting other) const { return bits_ < other.bits_; }

    /// The nearer of two; `farther` gets the other. Without a branch.
    friend Waiting take_nearer(Waiting a, Waiting b, Waiting& farther) {
        farther.bits_ = a.bits_ < b.bits_ ? b.bits_ : a.bits_;
        a.bits_ = a.bits_ < b.bits_ ? a.bits_ : b.bits_;
        return a;
    }

private:
    std::uint64_t bits_;
};

/// The triangles of a block, tested all at once. What intersect_triangle decides in double is left to it: the result
/// is the same to the bit.
class BlockTest {
public:
    [[gnu::always_inline]] BlockTest(const ShearedRay& ray, const TriangleBlock& block, float end) {
        const TriangleTest<Batch> test(ray, Vertex{block.corner[0]}, Vertex{block.corner[1]}, Vertex{block.corner[2]});
        const Batch zero(0.0f);
        const Batch low = xsimd::min(xsimd::min(test.e0, test.e1), test.e2);
        const Batch high = xsimd::max(xsimd::max(test.e0, test.e1), test.e2);
        const auto inside = (low >= zero) | (high <= zero);
        candidates_ = lane_bits(inside);
        if (candidates_ == 0) return;
        const Batch inv_det = Batch(1.0f) / test.det();
        const Batch t = test.distance(inv_det), error = test.distance_error(inv_det);
        const unsigned needles = lane_bits(test.is_needle(inv_det));
        const auto outside = (t < -error) | (t - error > Batch(end)); // and not NaN
        candidates_ &= ~lane_bits(outside) | needles;
        if (candidates_ == 0) return;
        certain_ = lane_bits((xsimd::abs(t) > error) & ((low > zero) | (high < zero))) & ~needles;
        t.store_aligned(t_.data());
        (test.e1 * inv_det).store_aligned(u_.data());
        (test.e2 * inv_det).store_aligned(v_.data());
    }

    /// The triangles that the ray may hit before the end, a bit each: all that it does hit, and hardly any other.
    unsigned candidates() const { return candidates_; }

    std::optional<TriangleHit> hit(std::size_t lane, const ShearedRay& ray, const TriangleBlock& block) const {
        if (certain_ >> lane & 1) {
            if (!(t_[lane] > ray.t_min && t_[lane] <= ray.t_max)) return std::nullopt;
            return TriangleHit{t_[lane], u_[lane], v_[lane]};
        }
        const auto vertex = [&](std::size_t corner) {
            const auto& p = block.corner[corner];
            return Vec3(p[0][lane], p[1][lane], p[2][lane]);
        };
        return intersect_triangle(ray, vertex(0), vertex(1), vertex(2));
    }

private:
    using Batch = FloatBatch<TriangleBlock::kSize>;
    struct Vertex {
        const std::array<TriangleBlock::Lanes<float>, 3>& axes;
        Batch operator[](std::size_t axis) const { return Batch::load_aligned(axes[axis].data()); }
    };

    unsigned candidates_, certain_;
    alignas(32) TriangleBlock::Lanes<float> t_, u_, v_;
};

/// Looks for the primitive that comes before `best`, in the order of `precedes`, and leaves it there; best.t is the end
/// of the ray. With kAny it stops at the first that comes before `best` and is not best's own primitive: a shadow ray
/// to a light passes the light itself as `best`. Returns whether there was one. `object` stands for the objects of the
/// primitives where it is not kNoObject (an instance's). `instance(i, best)` is asked for instances' hits, in the same
/// manner.
template <bool kAny, typename Instance>
bool traverse(const Bvh& bvh, const Ray& ray, std::uint32_t object, Hit& best, Instance&& instance) {
    if (bvh.empty()) return false;
    const SlabRay slabs(ray, bvh.bounds);
    ShearedRay sheared(ray);
    Ray ended = ray;
    bool found = false;

    // True where the search is over.
    const auto consider = [&](const Hit& hit) {
        if (!precedes(hit, best)) return false;
        if (kAny && hit.object == best.object && hit.primitive == best.primitive) return false;
        found = true;
        if (!kAny) best = hit;
        return kAny;
    };
    const auto name = [&](std::uint32_t own) { return object == kNoObject ? own : object; };
    const auto test_leaf = [&](BvhRef leaf) __attribute__((always_inline)) {
        const std::uint32_t end = leaf.index() + leaf.count();
        sheared.t_max = ended.t_max = best.t;
        switch (leaf.kind()) {
        case PrimitiveKind::kTriangle:
            for (std::uint32_t i = leaf.index(); i < end; ++i) {
                const TriangleBlock& block = bvh.triangles[i];
                const BlockTest test(sheared, block, best.t);
                for (unsigned lanes = test.candidates(); lanes != 0; lanes &= lanes - 1) {
                    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
                    if (const auto hit = test.hit(lane, sheared, block))
                        if (consider({name(block.object[lane]), block.primitive[lane], hit->u, hit->v, hit->t}))
                            return true;
                }
            }
            break;
        case PrimitiveKind::kQuad:
            for (std::uint32_t i = leaf.index(); i < end; ++i) {
                const BvhQuad& p = bvh.quads[i];
                if (const auto hit = intersect_quad(sheared, p.quad))
                    if (consider({name(p.object), p.primitive, hit->u, hit->v, hit->t})) return true;
            }
            break;
        case PrimitiveKind::kSphere:
            for (std::uint32_t i = leaf.index(); i < end; ++i) {
                const BvhSphere& p = bvh.spheres[i];
                if (const auto t = intersect_sphere(ended, p.sphere))
                    if (consider({name(p.object), p.primitive, 0, 0, *t})) return true;
            }
            break;
        case PrimitiveKind::kInstance:
            for (std::uint32_t i = leaf.index(); i < end; ++i)
                if (instance(bvh.instances[i], best)) {
                    found = true;
                    if (kAny) return true;
                }
            break;
        }
        return false;
    };

    // Each step down leaves at most kWidth − 1 children waiting.
    std::array<Waiting, (BvhNode::kWidth - 1) * Bvh::kMaxDepth + 1> stack;
    std::size_t size = 0;
    const SlabRay::Batch t_min(ray.t_min);
    BvhRef next = bvh.root;
    for (;;) {
        while (!next.is_leaf()) {
            const BvhNode& node = node_at(bvh, next);
            const auto [distance, entered] = slabs.enter(node, t_min, SlabRay::Batch(best.t));
            unsigned children = entered;
            if (children == 0) break;
            const auto first = static_cast<std::size_t>(std::countr_zero(children));
            children &= children - 1;
            if (children == 0) {
                next = node.children[first];
                continue;
            }
            alignas(32) BvhNode::Lanes entry;
            distance.store_aligned(entry.data());
            const auto take = [&] {
                const auto child = static_cast<std::size_t>(std::countr_zero(children));
                children &= children - 1;
                return Waiting(entry[child], node.children[child]);
            };
            Waiting nearest(entry[first], node.children[first]);
            if (kAny) {
                do stack[size++] = take();
                while (children != 0);
            } else {
                const std::size_t bottom = size;
                nearest = take_nearer(nearest, take(), stack[size++]);
                while (children != 0) {
                    Waiting other;
                    nearest = take_nearer(nearest, take(), other);
                    // The farthest at the bottom.
                    std::size_t i = size++;
                    for (; i > bottom && stack[i - 1].nearer_than(other); --i) stack[i] = stack[i - 1];
                    stack[i] = other;
                }
            }
            next = nearest.child();
        }
        if (next.is_leaf() && test_leaf(next)) return true;
        do {
            if (size == 0) return found;
            --size;
        } while (stack[size].entry() > best.t);
        next = stack[size].child();
    }
}

} // namespace duet::raytrace

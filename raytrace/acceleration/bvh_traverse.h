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
/// tests compute: the origin is moved by the error of a triangle's sheared vertices, once a ray, by the size of the
/// whole hierarchy as seen from there; and the reciprocals are scaled by more than the rounding of both tests.
class SlabRay {
public:
    SlabRay(const Ray& ray, const Box3& bounds) {
        const float relative = sabotaged(Guard::kEnlargedBoxes)
                                   ? 0.0f
                                   : 0x1p-20f; // 16 roundings: Woop et al. have 5, and the triangle's distance 6 more
        const Vec3 extent = max(abs(bounds.low - ray.origin), abs(bounds.high - ray.origin));
        const float largest = extent[longest_axis(abs(ray.direction))];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float error =
                (extent[axis] + largest + abs(ray.origin[axis])) * relative + std::numeric_limits<float>::min();
            const float reciprocal = 1 / ray.direction[axis]; // ±infinity for ±0: the slab is entered at −∞, or never
            const bool negative = std::signbit(ray.direction[axis]);
            const float away = negative ? -error : error;
            near_plane_[axis] = axis + (negative ? 3 : 0);
            far_plane_[axis] = axis + (negative ? 0 : 3);
            near_origin_[axis] = ray.origin[axis] + away;
            far_origin_[axis] = ray.origin[axis] - away;
            near_scale_[axis] = reciprocal * (1 - relative);
            far_scale_[axis] = reciprocal * (1 + relative);
        }
    }

    /// Where the ray enters each child's box, and whether it does so at a distance in [t_min, t_max].
    void enter(const BvhNode& node, float t_min, float t_max, BvhNode::Lanes& entry,
               std::array<std::uint32_t, BvhNode::kWidth>& entered) const {
        const BvhNode::Lanes &near_x = node.planes[near_plane_[0]], &near_y = node.planes[near_plane_[1]],
                             &near_z = node.planes[near_plane_[2]], &far_x = node.planes[far_plane_[0]],
                             &far_y = node.planes[far_plane_[1]], &far_z = node.planes[far_plane_[2]];
        for (std::size_t i = 0; i < BvhNode::kWidth; ++i) {
            // 0 · ∞ = NaN, of a ray in the plane of a box's face, comes second in min and max, which return it only if
            // the comparison with it holds: it never does, and that slab does not count.
            const float nx = (near_x[i] - near_origin_.x) * near_scale_.x;
            const float ny = (near_y[i] - near_origin_.y) * near_scale_.y;
            const float nz = (near_z[i] - near_origin_.z) * near_scale_.z;
            const float fx = (far_x[i] - far_origin_.x) * far_scale_.x;
            const float fy = (far_y[i] - far_origin_.y) * far_scale_.y;
            const float fz = (far_z[i] - far_origin_.z) * far_scale_.z;
            const float near = max(max(max(t_min, nx), ny), nz);
            const float far = min(min(min(t_max, fx), fy), fz);
            entry[i] = near;
            entered[i] = near <= far ? 1 : 0;
        }
    }

private:
    std::array<std::size_t, 3> near_plane_, far_plane_;
    Vec3 near_origin_, far_origin_, near_scale_, far_scale_;
};

/// Whether a ray can be traced: finite, with a direction. Others hit nothing.
inline bool traceable(const Ray& ray) {
    return is_finite(ray.origin) && is_finite(ray.direction) && max_component(abs(ray.direction)) > 0;
}

/// A child that waits to be visited: where the ray enters its box, and which it is. In one number, so that a stack of
/// them is written and sorted at least cost: distances that are not negative are ordered like their bits.
class Waiting {
public:
    Waiting() = default; // without a value: nobody should clear a stack of these for each ray
    Waiting(float entry, std::uint32_t node, std::uint32_t child)
        : bits_(std::uint64_t{std::bit_cast<std::uint32_t>(entry)} << 32 | (node * kWidth + child)) {}

    float entry() const { return std::bit_cast<float>(static_cast<std::uint32_t>(bits_ >> 32)); }
    std::uint32_t node() const { return static_cast<std::uint32_t>(bits_) / kWidth; }
    std::uint32_t child() const { return static_cast<std::uint32_t>(bits_) % kWidth; }
    bool nearer_than(Waiting other) const { return bits_ < other.bits_; }

private:
    static constexpr std::uint32_t kWidth = BvhNode::kWidth;
    std::uint64_t bits_;
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
    const auto test_leaf = [&](const BvhRef& leaf) {
        const std::uint32_t end = leaf.first + leaf.count;
        sheared.t_max = ended.t_max = best.t;
        switch (leaf.kind) {
        case PrimitiveKind::kTriangle:
            for (std::uint32_t i = leaf.first; i < end; ++i) {
                const BvhTriangle& p = bvh.triangles[i];
                if (const auto hit = intersect_triangle(sheared, p.a, p.b, p.c))
                    if (consider({name(p.object), p.primitive, hit->u, hit->v, hit->t})) return true;
            }
            break;
        case PrimitiveKind::kQuad:
            for (std::uint32_t i = leaf.first; i < end; ++i) {
                const BvhQuad& p = bvh.quads[i];
                if (const auto hit = intersect_quad(sheared, p.quad))
                    if (consider({name(p.object), p.primitive, hit->u, hit->v, hit->t})) return true;
            }
            break;
        case PrimitiveKind::kSphere:
            for (std::uint32_t i = leaf.first; i < end; ++i) {
                const BvhSphere& p = bvh.spheres[i];
                if (const auto t = intersect_sphere(ended, p.sphere))
                    if (consider({name(p.object), p.primitive, 0, 0, *t})) return true;
            }
            break;
        case PrimitiveKind::kInstance:
            for (std::uint32_t i = leaf.first; i < end; ++i)
                if (instance(bvh.instances[i], best)) {
                    found = true;
                    if (kAny) return true;
                }
            break;
        }
        return false;
    };

    if (bvh.root.leaf()) return test_leaf(bvh.root) || found;
    // Each step down leaves at most kWidth − 1 children waiting; the last kWidth are those of the node at hand.
    std::array<Waiting, (BvhNode::kWidth - 1) * Bvh::kMaxDepth + BvhNode::kWidth + 1> stack;
    std::size_t size = 0;
    const auto enter = [&](std::uint32_t index) {
        BvhNode::Lanes entry;
        std::array<std::uint32_t, BvhNode::kWidth> entered;
        slabs.enter(bvh.nodes[index], ray.t_min, best.t, entry, entered);
        const std::size_t bottom = size;
        for (std::uint32_t i = 0; i < BvhNode::kWidth; ++i) { // without a branch: what is not entered is overwritten
            stack[size] = Waiting(entry[i], index, i);
            size += entered[i];
        }
        if (!kAny) // the nearest on top
            for (std::size_t i = bottom + 1; i < size; ++i) {
                const Waiting moving = stack[i];
                std::size_t j = i;
                for (; j > bottom && stack[j - 1].nearer_than(moving); --j) stack[j] = stack[j - 1];
                stack[j] = moving;
            }
    };
    enter(bvh.root.first);
    while (size > 0) {
        const Waiting next = stack[--size];
        if (next.entry() > best.t) continue;
        const BvhRef& child = bvh.nodes[next.node()].children[next.child()];
        if (!child.leaf())
            enter(child.first);
        else if (test_leaf(child))
            return true;
    }
    return found;
}

} // namespace duet::raytrace

// Sending a ray through a hierarchy: near children first, whatever lies beyond the nearest hit is skipped.
//
// The answer is that of testing every primitive, to the bit, ties included: boxes are tested so conservatively that
// none is skipped that holds a hit (Woop, Benthin and Wald 2013, «Watertight Ray/Triangle Intersection», §3.3), and
// what is as near as the nearest hit is still looked at.
#pragma once

#include "raytrace/acceleration/bvh_leaf.h"
#include "raytrace/acceleration/bvh_slabs.h"

namespace duet::raytrace {

inline const BvhNode& node_at(const Bvh& bvh, BvhRef ref) {
    return *reinterpret_cast<const BvhNode*>(reinterpret_cast<const char*>(bvh.nodes.data()) +
                                             std::size_t{ref.index()} * BvhRef::kNodeUnit);
}

/// Asks for what a visit of this child reads, before it is needed.
inline void prefetch(const Bvh& bvh, BvhRef child) {
    const bool leaf = child.is_leaf();
    if (leaf && child.kind() != PrimitiveKind::kTriangle) return; // few, and at hand
    const char* place = leaf ? reinterpret_cast<const char*>(bvh.triangles.data() + child.index())
                             : reinterpret_cast<const char*>(&node_at(bvh, child));
    constexpr std::size_t kLine = 64;
    for (std::size_t i = 0; i < (leaf ? sizeof(TriangleBlock) : sizeof(BvhNode)); i += kLine)
        __builtin_prefetch(place + i);
}

/// Numbers of a ray that are larger, and directions all of whose components are smaller than its reciprocal, would
/// overflow on the way. (Scenes are refused beyond 1e18 long before.)
inline constexpr float kLargestNumber = 1e37f;
/// Whether a ray can be traced: in range, with a direction. Others hit nothing.
inline bool traceable(const Ray& ray) {
    const auto in_range = [](Vec3 v) {
        const Vec3 size = abs(v);
        return size.x <= kLargestNumber && size.y <= kLargestNumber && size.z <= kLargestNumber; // and not NaN
    };
    return in_range(ray.origin) && in_range(ray.direction) && max_component(abs(ray.direction)) >= 1 / kLargestNumber;
}

/// A child that waits to be visited: where the ray enters its box, and which it is. In one number, so that a stack of
/// them is written and sorted at least cost: distances that are not negative are ordered like their bits.
class Waiting {
public:
    Waiting() = default; // without a value: nobody should clear a stack of these for each ray
    Waiting(float entry, BvhRef child)
        : bits_(std::uint64_t{std::bit_cast<std::uint32_t>(entry)} << 32 | child.bits()) {}

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

/// Where there is no tree to go through.
template <bool kAny, typename Instance>
[[gnu::noinline]] bool find_in_list(const Bvh& bvh, const Ray& ray, std::uint32_t object, Hit& best,
                                    const Instance& instance) {
    LeafTest<kAny, Instance> test_leaf(bvh, ray, object, instance);
    for (const BvhRef leaf : bvh.list)
        if (test_leaf(leaf, best)) return true;
    return test_leaf.found();
}

/// Looks for the primitive that comes before `best`, in the order of `precedes`, and leaves it there; best.t is the end
/// of the ray. Returns whether there was one. `object` stands for the objects of the primitives where it is not
/// kNoObject (an instance's). `instance(i, best)` is asked for instances' hits, in the same manner.
template <typename Instance>
bool find_closest(const Bvh& bvh, const Ray& ray, std::uint32_t object, Hit& best, const Instance& instance) {
    if (!bvh.use_tree()) return find_in_list<false>(bvh, ray, object, best, instance);
    const SlabRay slabs(ray, bvh.bounds);
    LeafTest<false, Instance> test_leaf(bvh, ray, object, instance);

    // Each step down leaves at most kWidth − 1 children waiting.
    std::array<Waiting, (BvhNode::kWidth - 1) * Bvh::kMaxDepth + 1> stack;
    std::size_t size = 0;
    const SlabRay::Batch t_min(ray.t_min);
    BvhRef next = BvhRef::node(0);
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
            const Lanes entry(distance);
            const auto take = [&] {
                const auto child = static_cast<std::size_t>(std::countr_zero(children));
                children &= children - 1;
                return Waiting(entry[child], node.children[child]);
            };
            const std::size_t bottom = size;
            Waiting nearest = take_nearer(Waiting(entry[first], node.children[first]), take(), stack[size++]);
            while (children != 0) {
                Waiting other;
                nearest = take_nearer(nearest, take(), other);
                // The farthest at the bottom.
                std::size_t i = size++;
                for (; i > bottom && stack[i - 1].nearer_than(other); --i) stack[i] = stack[i - 1];
                stack[i] = other;
            }
            next = nearest.child();
        }
        if (next.is_leaf()) test_leaf(next, best);
        do {
            if (size == 0) return test_leaf.found();
            --size;
        } while (stack[size].entry() > best.t);
        next = stack[size].child();
    }
}

/// Whether any primitive comes before `end` and is not end's own: a shadow ray to a light passes the light itself.
/// Stops at the first; the other arguments as above.
template <typename Instance>
bool find_any(const Bvh& bvh, const Ray& ray, std::uint32_t object, const Hit& end, const Instance& instance) {
    Hit best = end;
    if (!bvh.use_tree()) return find_in_list<true>(bvh, ray, object, best, instance);
    const SlabRay slabs(ray, bvh.bounds);
    LeafTest<true, Instance> test_leaf(bvh, ray, object, instance);

    std::array<BvhRef, (BvhNode::kWidth - 1) * Bvh::kMaxDepth + 1> stack;
    std::size_t size = 0;
    const SlabRay::Batch t_min(ray.t_min), t_max(end.t);
    BvhRef next = BvhRef::node(0);
    for (;;) {
        while (!next.is_leaf()) {
            const BvhNode& node = node_at(bvh, next);
            unsigned children = slabs.enter(node, t_min, t_max).children;
            if (children == 0) break;
            // The largest child, which is the last, first (Ogaki and Derouet-Jourdan 2016, «An N-ary BVH child node
            // sorting technique for occlusion test», sort by area likewise).
            next = node.children[static_cast<std::size_t>(31 - std::countl_zero(children))];
            for (; (children & (children - 1)) != 0; children &= children - 1)
                stack[size++] = node.children[static_cast<std::size_t>(std::countr_zero(children))];
        }
        if (next.is_leaf() && test_leaf(next, best)) return true;
        if (size == 0) return false;
        next = stack[--size];
    }
}

} // namespace duet::raytrace

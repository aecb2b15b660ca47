// These functions traverse a hierarchy with one ray: near children first, and without those beyond the closest hit.
//
// The result is bit-equal to that of testing every primitive, ties included. Box tests are so conservative that no
// box with a hit is skipped (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", §3.3), and boxes
// at the same distance as the closest hit are still visited.
#pragma once

#include "raytrace/acceleration/bvh_leaf.h"
#include "raytrace/acceleration/bvh_slabs.h"

namespace duet::raytrace {

inline const BvhNode& node_at(const Bvh& bvh, BvhRef ref) {
    return *reinterpret_cast<const BvhNode*>(reinterpret_cast<const char*>(bvh.nodes.data()) +
                                             std::size_t{ref.index()} * BvhRef::kNodeUnit);
}

/// Prefetches the memory that a visit of this child reads.
inline void prefetch(const Bvh& bvh, BvhRef child) {
    const bool leaf = child.is_leaf();
    if (leaf && child.kind() != PrimitiveKind::kTriangle) return; // other leaves are few, and mostly in a cache
    const char* address = leaf ? reinterpret_cast<const char*>(bvh.triangles.data() + child.index())
                               : reinterpret_cast<const char*>(&node_at(bvh, child));
    constexpr std::size_t kLine = 64;
    for (std::size_t i = 0; i < (leaf ? sizeof(TriangleBlock) : sizeof(BvhNode)); i += kLine)
        __builtin_prefetch(address + i);
}

/// Components of a ray larger than this, and directions with all components smaller than its reciprocal, would
/// overflow during traversal. (The scene loader rejects scenes beyond 1e18.)
inline constexpr float kLargestNumber = 1e37f;
/// Returns whether a ray can be traced: its components are in range, and its direction is not zero. Other rays hit
/// nothing.
inline bool traceable(const Ray& ray) {
    const auto in_range = [](Vec3 v) {
        const Vec3 size = abs(v);
        return size.x <= kLargestNumber && size.y <= kLargestNumber && size.z <= kLargestNumber; // false for NaN
    };
    return in_range(ray.origin) && in_range(ray.direction) && max_component(abs(ray.direction)) >= 1 / kLargestNumber;
}

/// Stores a child on the traversal stack: the distance at which the ray enters its box, and the reference to it.
/// Both are in one integer, so that a stack is written and sorted at least cost: floats that are not negative have
/// the same order as their bits.
class StackEntry {
public:
    StackEntry() = default; // not initialized, because that would clear a stack for each ray
    StackEntry(float entry, BvhRef child)
        : bits_(std::uint64_t{std::bit_cast<std::uint32_t>(entry)} << 32 | child.bits()) {}

    float entry() const { return std::bit_cast<float>(static_cast<std::uint32_t>(bits_ >> 32)); }
    BvhRef child() const { return BvhRef::from_bits(static_cast<std::uint32_t>(bits_)); }
    bool nearer_than(StackEntry other) const { return bits_ < other.bits_; }

    /// Returns the nearer of two and sets `farther` to the other, without a branch.
    friend StackEntry take_nearer(StackEntry a, StackEntry b, StackEntry& farther) {
        farther.bits_ = a.bits_ < b.bits_ ? b.bits_ : a.bits_;
        a.bits_ = a.bits_ < b.bits_ ? a.bits_ : b.bits_;
        return a;
    }

private:
    std::uint64_t bits_;
};

/// Tests the leaves of the list, in a hierarchy whose tree is not to be traversed.
template <bool kAny, typename Instance>
[[gnu::noinline]] bool find_in_list(const Bvh& bvh, const Ray& ray, std::uint32_t object, Hit& best,
                                    const Instance& instance) {
    LeafTest<kAny, Instance> test_leaf(bvh, ray, object, instance);
    for (const BvhRef leaf : bvh.list)
        if (test_leaf(leaf, best)) return true;
    return test_leaf.found();
}

/// Finds the first hit that comes before `best`, in the order of `precedes`, and stores it in `best`. On input,
/// best.t is the end of the ray. Returns whether there was such a hit. If `object` is not kNoObject (inside an
/// instance), hits report it as their object. `instance(i, best)` is called to find the hits of instances in the
/// same manner.
template <typename Instance>
bool find_closest(const Bvh& bvh, const Ray& ray, std::uint32_t object, Hit& best, const Instance& instance) {
    if (!bvh.use_tree()) return find_in_list<false>(bvh, ray, object, best, instance);
    const SlabRay slabs(ray, bvh.bounds);
    LeafTest<false, Instance> test_leaf(bvh, ray, object, instance);

    // A step down pushes at most kWidth − 1 children.
    std::array<StackEntry, (BvhNode::kWidth - 1) * Bvh::kMaxDepth + 1> stack;
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
                return StackEntry(entry[child], node.children[child]);
            };
            const std::size_t bottom = size;
            StackEntry nearest = take_nearer(StackEntry(entry[first], node.children[first]), take(), stack[size++]);
            while (children != 0) {
                StackEntry other;
                nearest = take_nearer(nearest, take(), other);
                // The children are sorted so that the farthest is lowest on the stack.
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

/// Returns whether any primitive other than that of `end` is hit before `end`. A shadow ray to a light thus ignores
/// the light itself. The search ends at the first such hit. The other arguments are those of find_closest.
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
            // The largest child, which is the last, is visited first (Ogaki and Derouet-Jourdan 2016, "An N-ary BVH
            // child node sorting technique for occlusion test", sort by area likewise).
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

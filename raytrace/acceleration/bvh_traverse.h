// Traverses a hierarchy with one ray.
//
// The result is bit-equal to that of testing every primitive, ties included. Box tests are so conservative that no box
// with a hit is skipped (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", §3.3), and boxes at the
// same distance as the closest hit are still visited.
#pragma once

#include "raytrace/acceleration/bvh_leaf.h"
#include "raytrace/acceleration/bvh_slabs.h"

namespace duet::raytrace {

/// Returns the node that `ref` refers to, which must not be a leaf.
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

/// This is the largest component of a ray that can be traced. Larger components, and directions with all components
/// smaller than its reciprocal, would overflow during traversal. (The scene loader rejects scenes beyond 1e18.)
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

/// Stores a child on the traversal stack: the distance at which the ray enters its box, and the reference to it. Both
/// are packed into one integer, so that a stack is written and sorted at the least cost: nonnegative floats have the
/// same order as their bits.
class StackEntry {
public:
    StackEntry() = default; // not initialized, because that would clear a stack for each ray
    StackEntry(float entry, BvhRef child)
        : bits_(std::uint64_t{std::bit_cast<std::uint32_t>(entry)} << 32 | child.bits()) {}

    float entry() const { return std::bit_cast<float>(static_cast<std::uint32_t>(bits_ >> 32)); }
    BvhRef child() const { return BvhRef::from_bits(static_cast<std::uint32_t>(bits_)); }
    bool nearer_than(StackEntry other) const { return bits_ < other.bits_; }

    /// Returns the nearer of two entries and sets `farther` to the other, without a branch.
    friend StackEntry take_nearer(StackEntry a, StackEntry b, StackEntry& farther) {
        farther.bits_ = a.bits_ < b.bits_ ? b.bits_ : a.bits_;
        a.bits_ = a.bits_ < b.bits_ ? a.bits_ : b.bits_;
        return a;
    }

private:
    std::uint64_t bits_;
};

/// The stack holds the children that a ray has entered and not yet visited. A step down adds at most kWidth − 1 of
/// them.
inline constexpr std::size_t kStackSize = (BvhNode::kWidth - 1) * Bvh::kMaxDepth + 1;

/// Visits the nearest child first, so that nodes beyond the closest hit need not be visited.
class NearestFirst {
public:
    /// Returns the child of a node to visit next, and pushes the other children that the ray enters. `entered` is the
    /// bit mask of these children, not 0, and `distance` holds the distances at which the ray enters them.
    BvhRef descend(const BvhNode& node, const SlabRay::Batch& distance, unsigned entered) {
        const auto first = static_cast<std::size_t>(std::countr_zero(entered));
        entered &= entered - 1;
        if (entered == 0) return node.children[first];
        const Lanes entry(distance);
        const auto take = [&] {
            const auto child = static_cast<std::size_t>(std::countr_zero(entered));
            entered &= entered - 1;
            return StackEntry(entry[child], node.children[child]);
        };
        const std::size_t bottom = size_;
        StackEntry nearest = take_nearer(StackEntry(entry[first], node.children[first]), take(), stack_[size_++]);
        while (entered != 0) {
            StackEntry other;
            nearest = take_nearer(nearest, take(), other);
            // The children are sorted so that the farthest is lowest on the stack.
            std::size_t i = size_++;
            for (; i > bottom && stack_[i - 1].nearer_than(other); --i) stack_[i] = stack_[i - 1];
            stack_[i] = other;
        }
        return nearest.child();
    }
    /// Sets `next` to the last pushed child that the ray enters before `end`. Returns false if there is none.
    bool pop(float end, BvhRef& next) {
        do {
            if (size_ == 0) return false;
            --size_;
        } while (stack_[size_].entry() > end);
        next = stack_[size_].child();
        return true;
    }

private:
    std::array<StackEntry, kStackSize> stack_;
    std::size_t size_ = 0;
};

/// Visits the largest child of a node, which is the last one, first. It serves any-hit queries (Ogaki and
/// Derouet-Jourdan 2016, "An N-ary BVH child node sorting technique for occlusion test", also sort by area). The
/// functions are those of NearestFirst.
class LargestFirst {
public:
    BvhRef descend(const BvhNode& node, const SlabRay::Batch&, unsigned entered) {
        for (; (entered & (entered - 1)) != 0; entered &= entered - 1)
            stack_[size_++] = node.children[static_cast<std::size_t>(std::countr_zero(entered))];
        return node.children[static_cast<std::size_t>(std::countr_zero(entered))];
    }
    bool pop(float, BvhRef& next) {
        if (size_ == 0) return false;
        next = stack_[--size_];
        return true;
    }

private:
    std::array<BvhRef, kStackSize> stack_;
    std::size_t size_ = 0;
};

/// Tests the leaves of the list, for a hierarchy whose tree is not to be traversed.
template <bool kAny, typename Instance>
[[gnu::noinline]] bool traverse_list(const Bvh& bvh, const Ray& ray, std::uint32_t object, Hit& best,
                                     const Instance& instance, const AlphaFilter* alpha) {
    LeafTest<kAny, Instance> test_leaf(bvh, ray, object, instance, alpha);
    for (const BvhRef leaf : bvh.list)
        if (test_leaf(leaf, best)) return true;
    return test_leaf.found();
}

/// Traverses the hierarchy with a ray that ends at best.t.
/// - Without kAny: stores the first hit that comes before `best`, in the order of `precedes`, in `best`. Returns
///   whether there was such a hit.
/// - With kAny: returns whether any primitive other than that of `best` is hit before it. A shadow ray to a light thus
///   ignores the light itself. The search ends at the first such hit.
///
/// If `object` is not kNoObject (inside an instance), hits report it as their object. `instance(i, best)` is called to
/// find the hits of instances in the same manner. Hits that `alpha` rejects do not count.
template <bool kAny, typename Instance>
bool traverse(const Bvh& bvh, const Ray& ray, std::uint32_t object, Hit& best, const Instance& instance,
              const AlphaFilter* alpha = nullptr) {
    if (!bvh.use_tree()) return traverse_list<kAny>(bvh, ray, object, best, instance, alpha);
    const SlabRay slabs(ray, bvh.bounds);
    LeafTest<kAny, Instance> test_leaf(bvh, ray, object, instance, alpha);
    std::conditional_t<kAny, LargestFirst, NearestFirst> children;
    const SlabRay::Batch t_min(ray.t_min);
    BvhRef next = BvhRef::node(0);
    for (;;) {
        while (!next.is_leaf()) {
            const BvhNode& node = node_at(bvh, next);
            const auto [distance, entered] = slabs.enter(node, t_min, SlabRay::Batch(best.t));
            if (entered == 0) break;
            next = children.descend(node, distance, entered);
        }
        if (next.is_leaf() && test_leaf(next, best)) return true;
        if (!children.pop(best.t, next)) return test_leaf.found();
    }
}

} // namespace duet::raytrace

// The bounding volume hierarchy: what it is made of. bvh_build.cpp makes a binary tree of boxes, bvh_collapse.cpp packs
// it into these nodes, bvh_traverse.h sends rays through.
#pragma once

#include "common/geometry/shape.h"
#include "common/system/huge_pages.h"
#include "common/vec/box.h"
#include "common/vec/simd.h"

#include <array>
#include <cstdint>
#include <vector>

namespace duet::raytrace {

/// What a leaf holds. All primitives of a leaf are of one kind, so that its loop tests one thing.
enum class PrimitiveKind : std::uint8_t { kTriangle, kQuad, kSphere, kInstance };

// Primitives are kept in the order of the leaves, with all that their test needs: a leaf reads consecutive memory.
// `object` and `primitive` are what a Hit names; in the hierarchy of an instanced shape `object` is the instance's.

/// Triangles that are tested at once. Absent ones are NaN, which nothing hits.
struct alignas(32) TriangleBlock {
    static constexpr std::size_t kSize = kSimdLanes;
    template <typename T> using Lanes = std::array<T, kSize>;

    std::array<std::array<Lanes<float>, 3>, 3> corner; ///< a, b, c; of each x, y, z
    Lanes<std::uint32_t> object, primitive;

    void set(std::size_t lane, Vec3 a, Vec3 b, Vec3 c, std::uint32_t its_object, std::uint32_t its_primitive) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corner[0][axis][lane] = a[axis];
            corner[1][axis][lane] = b[axis];
            corner[2][axis][lane] = c[axis];
        }
        object[lane] = its_object;
        primitive[lane] = its_primitive;
    }
    Vec3 vertex(std::size_t of, std::size_t lane) const {
        return {corner[of][0][lane], corner[of][1][lane], corner[of][2][lane]};
    }
};
struct BvhQuad {
    Quad quad;
    std::uint32_t object, primitive;
};
struct BvhSphere {
    Sphere sphere;
    std::uint32_t object, primitive;
};
struct BvhInstance {
    std::uint32_t object, shape; ///< indices into Scene::objects and Scene::shapes
};

/// A child of a node, or the root: an inner node, or a leaf of primitives of one kind. (Without initializers: a
/// traversal's stack is an array of these, which nobody should clear for each ray.)
class BvhRef {
public:
    /// Nodes, and elements of each kind's list: indices are below this.
    static constexpr std::size_t kMaxIndex = std::size_t{1} << 26;
    static constexpr std::uint32_t kMaxCount = 8;

    BvhRef() = default;
    static constexpr std::size_t kNodeUnit = 32;
    static BvhRef node(std::uint32_t index);
    /// `count` elements from `first` in the list of the kind, 1 to kMaxCount.
    static BvhRef leaf(PrimitiveKind kind, std::uint32_t first, std::uint32_t count) {
        return BvhRef(static_cast<std::uint32_t>(kind) << 29 | (count - 1) << 26 | first);
    }
    static BvhRef from_bits(std::uint32_t bits) { return BvhRef(bits); }

    bool is_leaf() const { return (bits_ & kNode) == 0; }
    std::uint32_t index() const { return bits_ & (kMaxIndex - 1); }
    std::uint32_t count() const { return (bits_ >> 26 & 7) + 1; }
    PrimitiveKind kind() const { return static_cast<PrimitiveKind>(bits_ >> 29 & 3); }
    std::uint32_t bits() const { return bits_; }

private:
    explicit BvhRef(std::uint32_t bits) : bits_(bits) {}
    // Leaves have the smaller numbers: of children at equal distance, as those are whose boxes a ray begins in, they are
    // tested first, and may spare it the others.
    static constexpr std::uint32_t kNode = 1u << 31;
    std::uint32_t bits_;
};

/// A node with the boxes of up to kWidth children, each of their six planes in an array of its own: one instruction
/// tests a plane of all children against a ray. Children are dense; the boxes of absent ones are empty and hit by no
/// ray.
struct alignas(32) BvhNode {
    static constexpr std::size_t kWidth = kSimdLanes;
    using Lanes = std::array<float, kWidth>;

    std::array<Lanes, 6> planes; ///< low x, y, z, high x, y, z
    std::array<BvhRef, kWidth> children;
};

inline BvhRef BvhRef::node(std::uint32_t index) {
    return BvhRef(kNode | index * static_cast<std::uint32_t>(sizeof(BvhNode) / kNodeUnit));
}

struct Bvh {
    /// The longest way from the root to a leaf: bounds a traversal's stack.
    static constexpr int kMaxDepth = 96;
    static constexpr std::uint32_t kMaxLeaf = TriangleBlock::kSize; ///< primitives

    BvhRef root = BvhRef::node(0);
    Box3 bounds;
    std::size_t references = 0; ///< primitives in leaves; one that is cut counts in each
    std::vector<BvhNode, HugePageAllocator<BvhNode>> nodes;
    std::vector<TriangleBlock, HugePageAllocator<TriangleBlock>> triangles;
    std::vector<BvhQuad> quads;
    std::vector<BvhSphere> spheres;
    std::vector<BvhInstance> instances;

    bool empty() const { return bounds.empty(); }
    std::int64_t memory_bytes() const;
};

} // namespace duet::raytrace

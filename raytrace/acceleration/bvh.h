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

/// Primitives that are tested at once.
inline constexpr std::size_t kBlockSize = kSimdLanes;
template <typename T> using BlockLanes = std::array<T, kBlockSize>;

/// Triangles or quads. Absent ones are NaN, which nothing hits.
template <std::size_t kCorners> struct alignas(kSimdLanes * sizeof(float)) PolygonBlock {
    std::array<std::array<BlockLanes<float>, 3>, kCorners> corner; ///< of each x, y, z
    BlockLanes<std::uint32_t> object, primitive;

    void set(std::size_t lane, const std::array<Vec3, kCorners>& corners, std::uint32_t its_object,
             std::uint32_t its_primitive) {
        for (std::size_t i = 0; i < kCorners; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) corner[i][axis][lane] = corners[i][axis];
        object[lane] = its_object;
        primitive[lane] = its_primitive;
    }
    std::array<Vec3, kCorners> corners(std::size_t lane) const {
        std::array<Vec3, kCorners> result;
        for (std::size_t i = 0; i < kCorners; ++i)
            result[i] = {corner[i][0][lane], corner[i][1][lane], corner[i][2][lane]};
        return result;
    }
};
using TriangleBlock = PolygonBlock<3>;
using QuadBlock = PolygonBlock<4>;

/// Spheres: the only primitive of their object, 0. Absent ones are NaN, which nothing hits.
struct alignas(kSimdLanes * sizeof(float)) SphereBlock {
    std::array<BlockLanes<float>, 3> center;
    BlockLanes<float> radius;
    BlockLanes<std::uint32_t> object;

    void set(std::size_t lane, const Sphere& sphere, std::uint32_t its_object) {
        for (std::size_t axis = 0; axis < 3; ++axis) center[axis][lane] = sphere.center[axis];
        radius[lane] = sphere.radius;
        object[lane] = its_object;
    }
    Sphere sphere(std::size_t lane) const {
        return {{center[0][lane], center[1][lane], center[2][lane]}, radius[lane]};
    }
};
struct BvhInstance {
    std::uint32_t object, shape; ///< indices into Scene::objects and Scene::shapes
};

/// A child of a node, or the root: an inner node, or a leaf of primitives of one kind. (Without initializers: a
/// traversal's stack is an array of these, which nobody should clear for each ray.)
class BvhRef {
public:
    /// Nodes, and elements of each kind's list: indices are below this.
    static constexpr std::size_t kMaxIndex = std::size_t{1} << 29;

    BvhRef() = default;
    static constexpr std::size_t kNodeUnit = 32;
    static BvhRef node(std::uint32_t index);
    /// The element of the kind's list: a block of primitives, or an instance.
    static BvhRef leaf(PrimitiveKind kind, std::uint32_t index) {
        return BvhRef(static_cast<std::uint32_t>(kind) << 29 | index);
    }
    static BvhRef from_bits(std::uint32_t bits) { return BvhRef(bits); }

    bool is_leaf() const { return (bits_ & kNode) == 0; }
    std::uint32_t index() const { return bits_ & (kMaxIndex - 1); }
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

    Box3 box(std::size_t child) const {
        return {{planes[0][child], planes[1][child], planes[2][child]},
                {planes[3][child], planes[4][child], planes[5][child]}};
    }
};

inline BvhRef BvhRef::node(std::uint32_t index) {
    return BvhRef(kNode | index * static_cast<std::uint32_t>(sizeof(BvhNode) / kNodeUnit));
}

struct Bvh {
    /// The longest way from the root to a leaf: bounds a traversal's stack.
    static constexpr int kMaxDepth = 96;
    static constexpr std::uint32_t kMaxLeaf = kBlockSize; ///< primitives

    Box3 bounds;
    std::size_t references = 0; ///< primitives in leaves; one that is cut counts in each
    /// All primitives, where single rays are sooner through with them than with the tree.
    std::vector<BvhRef> list;
    /// The tree; the first is its root. None where there is but one leaf, which is the list.
    std::vector<BvhNode, HugePageAllocator<BvhNode>> nodes;
    std::vector<TriangleBlock, HugePageAllocator<TriangleBlock>> triangles;
    std::vector<QuadBlock> quads;
    std::vector<SphereBlock> spheres;
    std::vector<BvhInstance> instances;

    bool empty() const { return bounds.empty(); }
    bool has_polygons() const { return !triangles.empty() || !quads.empty(); }
    /// Whether single rays go through the tree, not the list; packets do wherever there is one.
    bool use_tree() const { return list.empty() && !nodes.empty(); }
    std::int64_t memory_bytes() const;
};

} // namespace duet::raytrace

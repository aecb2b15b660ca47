// Defines the data structures of the bounding volume hierarchy. bvh_build.cpp builds a binary tree of boxes,
// bvh_collapse.cpp packs it into these wide nodes, and bvh_traverse.h traverses them.
#pragma once

#include "common/geometry/shape.h"
#include "common/vec/box.h"
#include "common/vec/simd.h"
#include "common/system/huge_pages.h"

#include <array>
#include <cstdint>
#include <vector>

namespace duet::raytrace {

/// Names the kind of a leaf's primitives. All primitives of a leaf are of one kind, so that the leaf loop runs only
/// one intersection test.
enum class PrimitiveKind : std::uint8_t { kTriangle, kQuad, kSphere, kInstance };

// The following structures store primitives in leaf order, with everything that their intersection tests need, so that
// a leaf reads consecutive memory. `object` and `primitive` are the indices that a Hit reports. In the hierarchy of an
// instanced shape, hits report the instance's object instead of `object`.

/// This is the number of primitives that are tested at once with SIMD.
inline constexpr std::size_t kBlockSize = kSimdLanes;
template <typename T> using BlockLanes = std::array<T, kBlockSize>;

/// Stores a block of triangles or quads in structure-of-arrays layout. Unused lanes hold NaN, which no ray hits.
template <std::size_t kCorners> struct alignas(kSimdLanes * sizeof(float)) PolygonBlock {
    std::array<std::array<BlockLanes<float>, 3>, kCorners> corner; ///< [corner][axis][lane]
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

/// Stores a block of spheres in structure-of-arrays layout. A sphere is the only primitive of its object, so its
/// primitive index is 0. Unused lanes hold NaN, which no ray hits.
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
/// Represents a leaf of the world's hierarchy: an object whose shape has a hierarchy of its own.
struct BvhInstance {
    std::uint32_t object, shape; ///< indices into Scene::objects and Scene::shapes
};

/// Refers to a child of a node or to the root: an inner node, or a leaf of primitives of one kind. It has no member
/// initializers, because a traversal stack is an array of these and must not be cleared for each ray.
class BvhRef {
public:
    /// Indices of nodes (in units of kNodeUnit bytes) and of elements in each kind's list are below this.
    static constexpr std::size_t kMaxIndex = std::size_t{1} << 29;

    BvhRef() = default;
    static constexpr std::size_t kNodeUnit = 32;
    static BvhRef node(std::uint32_t index);
    /// Refers to an element of the kind's list: a block of primitives, or an instance.
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
    // Leaves compare less than inner nodes. Among children at equal entry distance, such as boxes that contain the
    // ray's origin, leaves are thus tested first, and a hit in them may cull the others.
    static constexpr std::uint32_t kNode = 1u << 31;
    std::uint32_t bits_;
};

/// Stores a wide node with the boxes of up to kWidth children. Each of their six planes has an array of its own, so
/// that one SIMD instruction tests a plane of all children against a ray. Children are packed at the front. Unused
/// children have empty boxes, which no ray hits.
struct alignas(32) BvhNode {
    static constexpr std::size_t kWidth = kSimdLanes;
    using Lanes = std::array<float, kWidth>;

    std::array<Lanes, 6> planes; ///< low x, y, z, high x, y, z
    std::array<BvhRef, kWidth> children;

    /// Returns a plane's values for all children. `offset` is the plane's position in the node, in bytes.
    const float* plane(std::size_t offset) const {
        return reinterpret_cast<const float*>(reinterpret_cast<const char*>(this) + offset);
    }
    Box3 box(std::size_t child) const {
        return {{planes[0][child], planes[1][child], planes[2][child]},
                {planes[3][child], planes[4][child], planes[5][child]}};
    }
};

inline BvhRef BvhRef::node(std::uint32_t index) {
    return BvhRef(kNode | index * static_cast<std::uint32_t>(sizeof(BvhNode) / kNodeUnit));
}

/// Holds a bounding volume hierarchy with the primitives of its leaves, stored as blocks for SIMD.
struct Bvh {
    /// This is the greatest depth of a leaf below the root. It bounds the size of a traversal stack.
    static constexpr int kMaxDepth = 96;
    static constexpr std::uint32_t kMaxLeaf = kBlockSize; ///< maximum number of primitives in a leaf

    Box3 bounds;
    std::size_t references = 0; ///< number of primitives in all leaves
    /// The leaves of this list hold all primitives, if a single ray tests them faster than it traverses the tree.
    /// Otherwise the list is empty.
    std::vector<BvhRef> list;
    /// nodes[0] is the root of the tree. There are no nodes if there is only one leaf, which is then in `list`.
    std::vector<BvhNode, HugePageAllocator<BvhNode>> nodes;
    std::vector<TriangleBlock, HugePageAllocator<TriangleBlock>> triangles;
    std::vector<QuadBlock> quads;
    std::vector<SphereBlock> spheres;
    std::vector<BvhInstance> instances;

    bool empty() const { return bounds.empty(); }
    bool has_polygons() const { return !triangles.empty() || !quads.empty(); }
    /// Returns whether single rays traverse the tree instead of testing `list`. Packets traverse the tree whenever
    /// there is one.
    bool use_tree() const { return list.empty() && !nodes.empty(); }
    std::int64_t memory_bytes() const;
};

} // namespace duet::raytrace

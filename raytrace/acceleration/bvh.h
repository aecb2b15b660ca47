// The bounding volume hierarchy: what it is made of. bvh_build.cpp makes a binary tree of boxes, bvh_collapse.cpp packs
// it into these nodes, bvh_traverse.h sends rays through.
#pragma once

#include "common/geometry/shape.h"
#include "common/vec/box.h"

#include <array>
#include <cstdint>
#include <vector>

namespace duet::raytrace {

/// What a leaf holds. All primitives of a leaf are of one kind, so that its loop tests one thing.
enum class PrimitiveKind : std::uint8_t { kTriangle, kQuad, kSphere, kInstance };

// Primitives are kept in the order of the leaves, with all that their test needs: a leaf reads consecutive memory.
// `object` and `primitive` are what a Hit names; in the hierarchy of an instanced shape `object` is the instance's.
struct BvhTriangle {
    Vec3 a, b, c;
    std::uint32_t object, primitive;
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

/// A child of a node, or the root: an inner node, or a leaf of `count` primitives. (Without initializers: a traversal's
/// stack is an array of these, which nobody should clear for each ray.)
struct BvhRef {
    std::uint32_t first; ///< index of the node, or of the first primitive in the list of its kind
    std::uint16_t count; ///< 0: an inner node
    PrimitiveKind kind;

    bool leaf() const { return count > 0; }
};

/// A node with the boxes of up to kWidth children, each of their six planes in an array of its own: one loop tests all
/// children against a ray, and the compiler turns it into vector instructions. Children are dense; the boxes of absent
/// ones are empty and hit by no ray.
struct alignas(64) BvhNode {
    static constexpr std::size_t kWidth = 8;
    using Lanes = std::array<float, kWidth>;

    std::array<Lanes, 6> planes; ///< low x, y, z, high x, y, z
    std::array<BvhRef, kWidth> children;
};

struct Bvh {
    /// The longest way from the root to a leaf: bounds a traversal's stack.
    static constexpr int kMaxDepth = 96;
    static constexpr std::uint32_t kMaxLeaf = 4;

    BvhRef root{};
    Box3 bounds;
    std::vector<BvhNode> nodes;
    std::vector<BvhTriangle> triangles;
    std::vector<BvhQuad> quads;
    std::vector<BvhSphere> spheres;
    std::vector<BvhInstance> instances;

    bool empty() const { return bounds.empty(); }
    std::int64_t memory_bytes() const;
};

} // namespace duet::raytrace

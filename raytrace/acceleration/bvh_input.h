// Declares BvhInput, which builds a hierarchy over the primitives of shapes and instances.
#pragma once

#include "common/scene/scene.h"
#include "raytrace/acceleration/bvh_build.h"

#include <span>
#include <vector>

namespace duet::raytrace {

/// Collects primitives of all kinds with their boxes, then builds a hierarchy over them. The shapes must outlive
/// build().
class BvhInput {
public:
    /// `threads` is the number of build threads (0 = all). The hierarchy does not depend on it.
    explicit BvhInput(int threads) : threads_(threads) {}

    /// Adds the primitives of a shape, without a transform. Their hits report `object`. Of opaque primitives with equal
    /// coordinates only one is kept. `seen_through` says that rays may pass through the primitives of the shape.
    void add_shape(const Shape& shape, std::uint32_t object, bool seen_through);
    /// Adds the world-space bounds of a transformed shape, over all of its motion. `index` is the index of the
    /// object.
    void add_instance(const Object& object, std::uint32_t index, const Shape& shape);
    /// Builds the hierarchy. It must be called only once, after all shapes and instances are added.
    Bvh build();

private:
    struct MeshTriangle {
        std::uint32_t mesh, primitive;
    };
    struct ObjectMesh {
        const Mesh* mesh;
        std::uint32_t object;
        bool seen_through;
    };
    struct ObjectQuad {
        std::array<Vec3, 4> corners;
        std::uint32_t object, primitive;
        bool seen_through;
    };
    struct ObjectSphere {
        Sphere sphere;
        std::uint32_t object;
        bool seen_through;
    };
    /// Holds everything that decides where a primitive is hit: its kind and the bits of its coordinates, or the index
    /// of one that has no duplicates.
    using PrimitiveKey = std::array<std::uint32_t, 13>;

    template <typename Body> void in_chunks(std::size_t count, const Body& body) const;
    void add_mesh(const Mesh& mesh, std::uint32_t object, bool seen_through);
    template <typename Primitive>
    void add(PrimitiveKind kind, const Box3& box, std::vector<Primitive>& list, const Primitive& primitive);
    std::size_t remove_duplicates(std::span<BuildItem> items) const;
    bool is_unique(const BuildItem& item) const;
    PrimitiveKey key_of(const BuildItem& item) const;

    void fill_leaf(Bvh& bvh, const LeafItems& leaf, std::span<const BuildItem> items) const;
    template <typename Block> void fill_block(Block& block, std::span<const BuildItem> items) const;
    void set(TriangleBlock& block, std::size_t lane, std::uint32_t index) const;
    void set(QuadBlock& block, std::size_t lane, std::uint32_t index) const;
    void set(SphereBlock& block, std::size_t lane, std::uint32_t index) const;

    int threads_;
    BuildItems items_;
    std::vector<ObjectMesh> meshes_;
    std::vector<MeshTriangle, HugePageAllocator<MeshTriangle>> triangles_;
    std::vector<ObjectQuad> quads_;
    std::vector<ObjectSphere> spheres_;
    std::vector<BvhInstance> instances_;
};

} // namespace duet::raytrace

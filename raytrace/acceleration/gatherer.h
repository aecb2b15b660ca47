// From shapes and instances to a hierarchy of their primitives.
#pragma once

#include "common/scene/scene.h"
#include "raytrace/acceleration/bvh_spatial.h"
#include "raytrace/acceleration/bvh_quality.h"

#include <span>
#include <vector>

namespace duet::raytrace {

/// Gathers primitives of all kinds with their boxes, then makes a hierarchy of them. Refers to the shapes until then.
class Gatherer {
public:
    /// threads: 0 = all; the hierarchy does not depend on it.
    Gatherer(BvhQuality quality, int threads) : quality_(quality), threads_(threads) {}

    /// A shape's primitives, as they are. `object`: what their hits name.
    void add_shape(const Shape& shape, std::uint32_t object);
    /// The bounds of a placed shape, over all its time. `index`: of the object.
    void add_instance(const Object& object, std::uint32_t index, const Shape& shape);
    /// Once, in the end.
    Bvh build();

private:
    struct MeshTriangle {
        std::uint32_t mesh, primitive;
    };
    struct PlacedMesh {
        const Mesh* mesh;
        std::uint32_t object;
    };
    struct PlacedQuad {
        std::array<Vec3, 4> corners;
        std::uint32_t object, primitive;
    };
    struct PlacedSphere {
        Sphere sphere;
        std::uint32_t object;
    };
    /// All that decides where a primitive is hit: its kind and the bits of its numbers; an instance's index.
    using Form = std::array<std::uint32_t, 13>;

    template <typename Body> void in_chunks(std::size_t count, const Body& body) const;
    void add_mesh(const Mesh& mesh, std::uint32_t object);
    template <typename Primitive>
    void add(PrimitiveKind kind, const Box3& box, std::vector<Primitive>& list, const Primitive& primitive);
    Outline outline(const BuildItem& item) const;
    std::size_t first_of_twins(std::span<BuildItem> items) const;
    Form form_of(const BuildItem& item) const;

    void fill_leaf(Bvh& bvh, const LeafItems& leaf, std::span<const BuildItem> items) const;
    template <typename Block> void fill_block(Block& block, std::span<const BuildItem> items) const;
    void set(TriangleBlock& block, std::size_t lane, std::uint32_t index) const;
    void set(QuadBlock& block, std::size_t lane, std::uint32_t index) const;
    void set(SphereBlock& block, std::size_t lane, std::uint32_t index) const;

    BvhQuality quality_;
    int threads_;
    BuildItems items_;
    std::vector<PlacedMesh> meshes_;
    std::vector<MeshTriangle, HugePageAllocator<MeshTriangle>> triangles_;
    std::vector<PlacedQuad> quads_;
    std::vector<PlacedSphere> spheres_;
    std::vector<BvhInstance> instances_;
};

} // namespace duet::raytrace

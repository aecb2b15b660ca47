#include "raytrace/acceleration/bvh_input.h"

#include "common/sampling/hash.h"
#include "common/scene/motion_bounds.h"
#include "common/system/parallel.h"
#include "common/vec/robust.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace duet::raytrace {

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr Vec3 kUnusedPoint{kNaN, kNaN, kNaN};

template <std::size_t kCorners> void set_unused(PolygonBlock<kCorners>& block, std::size_t lane) {
    std::array<Vec3, kCorners> corners;
    corners.fill(kUnusedPoint);
    block.set(lane, corners, kNoObject, 0);
}
void set_unused(SphereBlock& block, std::size_t lane) { block.set(lane, {kUnusedPoint, kNaN}, kNoObject); }

template <std::size_t N> std::uint64_t hash_of(const std::array<std::uint32_t, N>& words) {
    std::uint64_t hash = 0;
    for (const std::uint32_t word : words) hash = hash_combine(hash, word);
    return hash;
}

} // namespace

template <typename Body> void BvhInput::in_chunks(std::size_t count, const Body& body) const {
    constexpr std::size_t kChunk = std::size_t{1} << 14;
    parallel_for((count + kChunk - 1) / kChunk, threads_, [&](std::size_t chunk) {
        const std::size_t end = std::min(count, (chunk + 1) * kChunk);
        for (std::size_t i = chunk * kChunk; i < end; ++i) body(i);
    });
}

template <typename Primitive>
void BvhInput::add(PrimitiveKind kind, const Box3& box, std::vector<Primitive>& list, const Primitive& primitive) {
    items_.push_back({box, static_cast<std::uint32_t>(list.size()), kind});
    list.push_back(primitive);
}

void BvhInput::add_shape(const Shape& shape, std::uint32_t object, bool seen_through) {
    if (const auto* mesh = std::get_if<Mesh>(&shape)) {
        add_mesh(*mesh, object, seen_through);
    } else if (const auto* list = std::get_if<QuadList>(&shape)) {
        for (std::uint32_t i = 0; i < list->quads.size(); ++i) {
            Box3 box;
            for (const Vec3& p : corners(list->quads[i])) box.extend(p);
            add(PrimitiveKind::kQuad, box, quads_, {corners(list->quads[i]), object, i, seen_through});
        }
    } else {
        add(PrimitiveKind::kSphere, bounds(shape, Mat4()), spheres_, {std::get<Sphere>(shape), object, seen_through});
    }
}

void BvhInput::add_mesh(const Mesh& mesh, std::uint32_t object, bool seen_through) {
    const auto which = static_cast<std::uint32_t>(meshes_.size());
    meshes_.push_back({&mesh, object, seen_through});
    const std::size_t first_item = items_.size(), first_triangle = triangles_.size();
    items_.resize(first_item + mesh.triangles.size());
    triangles_.resize(first_triangle + mesh.triangles.size());
    in_chunks(mesh.triangles.size(), [&](std::size_t i) {
        Box3 box;
        for (const std::uint32_t vertex : mesh.triangles[i]) box.extend(mesh.positions[vertex]);
        items_[first_item + i] = {box, static_cast<std::uint32_t>(first_triangle + i), PrimitiveKind::kTriangle};
        triangles_[first_triangle + i] = {which, static_cast<std::uint32_t>(i)};
    });
}

void BvhInput::add_instance(const Object& object, std::uint32_t index, const Shape& shape) {
    Box3 box = motion_bounds(object, shape);
    // Hits are found in object space. The transform of the ray to object space has rounding errors, for which the box
    // gets a margin.
    const Vec3 margin = max(abs(box.low), abs(box.high)) * gamma_bound(16);
    box.extend(box.low - margin);
    box.extend(box.high + margin);
    add(PrimitiveKind::kInstance, box, instances_, {index, object.shape});
}

Bvh BvhInput::build() {
    const auto unique = [this](std::span<BuildItem> items) { return remove_duplicates(items); };
    BinaryTree tree = build_binary_tree(std::move(items_), threads_, unique);
    CollapsedBvh collapsed = collapse(tree, threads_);
    add_list_where_faster(tree, collapsed);
    tree.nodes = {}; // free this memory before the primitives are allocated
    Bvh& bvh = collapsed.bvh;
    const auto elements = [&](PrimitiveKind kind) { return collapsed.elements[static_cast<std::size_t>(kind)]; };
    bvh.triangles.resize(elements(PrimitiveKind::kTriangle));
    bvh.quads.resize(elements(PrimitiveKind::kQuad));
    bvh.spheres.resize(elements(PrimitiveKind::kSphere));
    bvh.instances.resize(elements(PrimitiveKind::kInstance));
    in_chunks(collapsed.leaves.size(), [&](std::size_t i) {
        const LeafItems& leaf = collapsed.leaves[i];
        fill_leaf(bvh, leaf, std::span<const BuildItem>(tree.items).subspan(leaf.first, leaf.count));
    });
    return std::move(bvh);
}

// Moves one primitive of each set of duplicates to the front, and returns the number of sets. Primitives with bit-equal
// corners, or spheres with bit-equal center and radius, are hit at exactly the same distance. There the lowest (object,
// primitive) wins, which has the lowest index here. A hash table finds duplicates in one pass. Instances are never
// duplicates, because they may move. Primitives that a ray may pass through are no duplicates either, because the ray
// may hit the next one.
std::size_t BvhInput::remove_duplicates(std::span<BuildItem> items) const {
    constexpr std::uint32_t kEmptySlot = ~0u;
    std::vector<std::uint32_t> slots(std::bit_ceil(2 * items.size()), kEmptySlot); // hash table of indices into `items`
    std::size_t unique = 0;
    for (const BuildItem& item : items) {
        const PrimitiveKey key = key_of(item);
        std::size_t slot = hash_of(key) & (slots.size() - 1);
        while (slots[slot] != kEmptySlot && key_of(items[slots[slot]]) != key) slot = (slot + 1) & (slots.size() - 1);
        if (slots[slot] != kEmptySlot) {
            std::uint32_t& index = items[slots[slot]].index;
            index = std::min(index, item.index);
            continue;
        }
        slots[slot] = static_cast<std::uint32_t>(unique);
        items[unique++] = item;
    }
    return unique;
}

bool BvhInput::is_unique(const BuildItem& item) const {
    switch (item.kind) {
    case PrimitiveKind::kTriangle:
        return meshes_[triangles_[item.index].mesh].seen_through;
    case PrimitiveKind::kQuad:
        return quads_[item.index].seen_through;
    case PrimitiveKind::kSphere:
        return spheres_[item.index].seen_through;
    case PrimitiveKind::kInstance:
        break;
    }
    return true;
}

BvhInput::PrimitiveKey BvhInput::key_of(const BuildItem& item) const {
    PrimitiveKey key{static_cast<std::uint32_t>(item.kind)};
    if (is_unique(item)) {
        constexpr std::uint32_t kUnique = 0x100; // differs from every kind of primitive
        key[0] |= kUnique;
        key[1] = item.index;
        return key;
    }
    std::size_t next = 1;
    const auto add = [&](Vec3 p) {
        for (std::size_t axis = 0; axis < 3; ++axis) key[next++] = std::bit_cast<std::uint32_t>(p[axis]);
    };
    if (item.kind == PrimitiveKind::kSphere) {
        const Sphere& sphere = spheres_[item.index].sphere;
        add(sphere.center);
        key[next] = std::bit_cast<std::uint32_t>(sphere.radius);
    } else if (item.kind == PrimitiveKind::kQuad) {
        for (const Vec3 corner : quads_[item.index].corners) add(corner);
    } else {
        const MeshTriangle& triangle = triangles_[item.index];
        const Mesh& mesh = *meshes_[triangle.mesh].mesh;
        for (const std::uint32_t corner : mesh.triangles[triangle.primitive]) add(mesh.positions[corner]);
    }
    return key;
}

void BvhInput::fill_leaf(Bvh& bvh, const LeafItems& leaf, std::span<const BuildItem> items) const {
    switch (items[0].kind) {
    case PrimitiveKind::kTriangle:
        return fill_block(bvh.triangles[leaf.element], items);
    case PrimitiveKind::kQuad:
        return fill_block(bvh.quads[leaf.element], items);
    case PrimitiveKind::kSphere:
        return fill_block(bvh.spheres[leaf.element], items);
    case PrimitiveKind::kInstance:
        for (std::size_t i = 0; i < items.size(); ++i) bvh.instances[leaf.element + i] = instances_[items[i].index];
    }
}

template <typename Block> void BvhInput::fill_block(Block& block, std::span<const BuildItem> items) const {
    for (std::size_t i = 0; i < kBlockSize; ++i) {
        if (i < items.size())
            set(block, i, items[i].index);
        else
            set_unused(block, i);
    }
}

void BvhInput::set(TriangleBlock& block, std::size_t lane, std::uint32_t index) const {
    const MeshTriangle& triangle = triangles_[index];
    const ObjectMesh& from = meshes_[triangle.mesh];
    const auto& [a, b, c] = from.mesh->triangles[triangle.primitive];
    const std::vector<Vec3>& p = from.mesh->positions;
    block.set(lane, {p[a], p[b], p[c]}, from.object, triangle.primitive);
}

void BvhInput::set(QuadBlock& block, std::size_t lane, std::uint32_t index) const {
    const ObjectQuad& quad = quads_[index];
    block.set(lane, quad.corners, quad.object, quad.primitive);
}

void BvhInput::set(SphereBlock& block, std::size_t lane, std::uint32_t index) const {
    block.set(lane, spheres_[index].sphere, spheres_[index].object);
}

} // namespace duet::raytrace

#include "raytrace/acceleration/accelerator.h"

#include "common/sampling/hash.h"
#include "common/scene/holes.h"
#include "common/system/parallel.h"
#include "common/vec/robust.h"
#include "raytrace/acceleration/bvh_hierarchy.h"
#include "raytrace/acceleration/bvh_packet.h"
#include "raytrace/acceleration/bvh_stream.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

namespace duet::raytrace {

namespace {

// Gathers primitives of all kinds with their boxes, then makes a hierarchy of them.
class Gatherer {
public:
    Gatherer(BvhQuality quality, int threads) : quality_(quality), threads_(threads) {}

    void add_shape(const Shape& shape, std::uint32_t object) {
        if (const auto* mesh = std::get_if<Mesh>(&shape)) {
            add_mesh(*mesh, object);
        } else if (const auto* list = std::get_if<QuadList>(&shape)) {
            for (std::uint32_t i = 0; i < list->quads.size(); ++i) {
                Box3 box;
                for (const Vec3& p : corners(list->quads[i])) box.extend(p);
                add(PrimitiveKind::kQuad, box, quads_, {corners(list->quads[i]), object, i});
            }
        } else {
            add(PrimitiveKind::kSphere, bounds(shape, Mat4()), spheres_, {std::get<Sphere>(shape), object});
        }
    }

    void add_instance(const Object& object, std::uint32_t index, const Shape& shape) {
        Box3 box = bounds(shape, object.to_world);
        // Matrix entries are interpolated, so each point moves on a straight line between its ends.
        if (object.moving) box.extend(bounds(shape, object.to_world_end));
        // The hit is found in the object's space, where the ray arrives with the rounding of its own transform.
        const Vec3 room = max(abs(box.low), abs(box.high)) * gamma_bound(16);
        box.extend(box.low - room);
        box.extend(box.high + room);
        add(PrimitiveKind::kInstance, box, instances_, {index, object.shape});
    }

    Bvh build() {
        const Primitives primitives{[this](const BuildItem& item) { return outline(item); },
                                    [this](std::span<BuildItem> items) { return first_of_twins(items); }};
        auto [items, collapsed] = build_hierarchy(std::move(items_), primitives, quality_, threads_);
        Bvh& bvh = collapsed.bvh;
        const auto elements = [&](PrimitiveKind kind) { return collapsed.elements[static_cast<std::size_t>(kind)]; };
        bvh.triangles.resize(elements(PrimitiveKind::kTriangle));
        bvh.quads.resize(elements(PrimitiveKind::kQuad));
        bvh.spheres.resize(elements(PrimitiveKind::kSphere));
        bvh.instances.resize(elements(PrimitiveKind::kInstance));
        in_chunks(collapsed.leaves.size(), [&, &items = items, &leaves = collapsed.leaves](std::size_t i) {
            const LeafItems& leaf = leaves[i];
            fill_leaf(bvh, leaf, std::span<const BuildItem>(items).subspan(leaf.first, leaf.count));
        });
        return std::move(bvh);
    }

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

    template <typename Body> void in_chunks(std::size_t count, const Body& body) const {
        constexpr std::size_t kChunk = std::size_t{1} << 14;
        parallel_for((count + kChunk - 1) / kChunk, threads_, [&](std::size_t chunk) {
            const std::size_t end = std::min(count, (chunk + 1) * kChunk);
            for (std::size_t i = chunk * kChunk; i < end; ++i) body(i);
        });
    }

    void add_mesh(const Mesh& mesh, std::uint32_t object) {
        const auto which = static_cast<std::uint32_t>(meshes_.size());
        meshes_.push_back({&mesh, object});
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
    // Of triangles and quads; nothing of others.
    Outline outline(const BuildItem& item) const {
        if (item.kind == PrimitiveKind::kTriangle) {
            const MeshTriangle& triangle = triangles_[item.index];
            const Mesh& mesh = *meshes_[triangle.mesh].mesh;
            const auto& [a, b, c] = mesh.triangles[triangle.primitive];
            return {{mesh.positions[a], mesh.positions[b], mesh.positions[c]}, 3};
        }
        if (item.kind == PrimitiveKind::kQuad) return {quads_[item.index].corners, 4};
        return {};
    }
    template <typename Primitive>
    void add(PrimitiveKind kind, const Box3& box, std::vector<Primitive>& list, const Primitive& primitive) {
        items_.push_back({box, static_cast<std::uint32_t>(list.size()), kind});
        list.push_back(primitive);
    }

    void fill_leaf(Bvh& bvh, const LeafItems& leaf, std::span<const BuildItem> items) const {
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

    // Primitives with the very same corners, or spheres with the same centre and radius, are hit at the very same
    // distance, where the lowest (object, primitive) wins: that of the lowest index here. A table of hashes finds them
    // in one walk, whatever their number. Instances are no twins: they may move.
    std::size_t first_of_twins(std::span<BuildItem> items) const {
        std::vector<std::uint32_t> seats(std::bit_ceil(2 * items.size()), kFree); // of `items`, by hash
        std::size_t kept = 0;
        for (const BuildItem& item : items) {
            const Form form = form_of(item);
            std::size_t seat = hash_of(form) & (seats.size() - 1);
            while (seats[seat] != kFree && form_of(items[seats[seat]]) != form) seat = (seat + 1) & (seats.size() - 1);
            if (seats[seat] != kFree) {
                std::uint32_t& index = items[seats[seat]].index;
                index = std::min(index, item.index);
                continue;
            }
            seats[seat] = static_cast<std::uint32_t>(kept);
            items[kept++] = item;
        }
        return kept;
    }

    /// All that decides where a primitive is hit: its kind and the bits of its numbers; an instance's index.
    using Form = std::array<std::uint32_t, 13>;
    static constexpr std::uint32_t kFree = ~0u;

    Form form_of(const BuildItem& item) const {
        Form form{static_cast<std::uint32_t>(item.kind)};
        std::size_t next = 1;
        const auto add = [&](Vec3 p) {
            for (std::size_t axis = 0; axis < 3; ++axis) form[next++] = std::bit_cast<std::uint32_t>(p[axis]);
        };
        if (item.kind == PrimitiveKind::kSphere) {
            const Sphere& sphere = spheres_[item.index].sphere;
            add(sphere.center);
            form[next] = std::bit_cast<std::uint32_t>(sphere.radius);
        } else if (item.kind == PrimitiveKind::kInstance) {
            form[next] = item.index;
        } else {
            const Outline polygon = outline(item);
            for (std::size_t i = 0; i < polygon.count; ++i) add(polygon.corners[i]);
        }
        return form;
    }
    static std::uint64_t hash_of(const Form& form) {
        std::uint64_t hash = 0;
        for (const std::uint32_t word : form) hash = hash_combine(hash, word);
        return hash;
    }

    template <typename Block> void fill_block(Block& block, std::span<const BuildItem> items) const {
        for (std::size_t i = 0; i < kBlockSize; ++i) {
            if (i < items.size())
                set(block, i, items[i].index);
            else
                set_absent(block, i);
        }
    }
    void set(TriangleBlock& block, std::size_t lane, std::uint32_t index) const {
        const MeshTriangle& triangle = triangles_[index];
        const auto& [mesh, object] = meshes_[triangle.mesh];
        const auto& [a, b, c] = mesh->triangles[triangle.primitive];
        block.set(lane, {mesh->positions[a], mesh->positions[b], mesh->positions[c]}, object, triangle.primitive);
    }
    void set(QuadBlock& block, std::size_t lane, std::uint32_t index) const {
        const PlacedQuad& quad = quads_[index];
        block.set(lane, quad.corners, quad.object, quad.primitive);
    }
    void set(SphereBlock& block, std::size_t lane, std::uint32_t index) const {
        block.set(lane, spheres_[index].sphere, spheres_[index].object);
    }

    static constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    static constexpr Vec3 kAbsent{kNaN, kNaN, kNaN};

    template <std::size_t kCorners> static void set_absent(PolygonBlock<kCorners>& block, std::size_t lane) {
        std::array<Vec3, kCorners> corners;
        corners.fill(kAbsent);
        block.set(lane, corners, kNoObject, 0);
    }
    static void set_absent(SphereBlock& block, std::size_t lane) { block.set(lane, {kAbsent, kNaN}, kNoObject); }

    BvhQuality quality_;
    int threads_;
    BuildItems items_;
    std::vector<PlacedMesh> meshes_;
    std::vector<MeshTriangle, HugePageAllocator<MeshTriangle>> triangles_;
    std::vector<PlacedQuad> quads_;
    std::vector<PlacedSphere> spheres_;
    std::vector<BvhInstance> instances_;
};

bool stands_in_world(const Object& object) { return object.identity && !object.moving; }

} // namespace

Accelerator::Accelerator(const Scene& scene, int threads, BvhQuality quality)
    : scene_(scene), quality_(quality), shapes_(scene.shapes.size()), holes_(scene.needs.alpha) {
    Gatherer world(quality, threads);
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const Shape& shape = scene.shapes[object.shape];
        primitives_ += primitive_count(shape);
        if (stands_in_world(object)) {
            world.add_shape(shape, i);
            continue;
        }
        world.add_instance(object, i, shape);
        if (!shapes_[object.shape].empty()) continue;
        Gatherer own(quality, threads);
        own.add_shape(shape, kNoObject);
        shapes_[object.shape] = own.build();
    }
    world_ = world.build();
    few_primitives_ = !world_.use_tree() && world_.instances.empty() && !holes_;
    streams_ = streamable(world_) && !sabotaged(Guard::kSphereRoots);
}

// A ray in an instance's space, at its time.
Ray Accelerator::inside(const BvhInstance& instance, const Ray& ray) const {
    const Object& object = scene_.objects[instance.object];
    if (!object.moving) return to_object_space(ray, object.to_world, object.to_object);
    const ObjectTransform transform = object_transform(object, ray.time);
    return to_object_space(ray, transform.to_world, transform.to_object);
}

// What an instance's hits are in its shape's hierarchy.
template <bool kAny> auto Accelerator::instance_test(const Ray& ray) const {
    return [this, &ray](const BvhInstance& instance, Hit& so_far) {
        const auto no_instance = [](const BvhInstance&, Hit&) { return false; };
        const Ray its = inside(instance, ray);
        if (!traceable(its)) return false;
        const Bvh& shape = shapes_[instance.shape];
        if constexpr (kAny)
            return find_any(shape, its, instance.object, so_far, no_instance);
        else
            return find_closest(shape, its, instance.object, so_far, no_instance);
    };
}

// The same for a packet.
struct Accelerator::PacketInstances {
    static constexpr std::size_t kSize = RayPacket::kSize;
    const Accelerator& scene;
    std::span<const Ray, kSize> rays;

    auto operator()(const Ray& ray) const { return scene.instance_test<false>(ray); }

    void operator()(const BvhInstance& instance, unsigned active, PacketHits& best) const {
        const Bvh& shape = scene.shapes_[instance.shape];
        std::array<Ray, kSize> its;
        its.fill(scene.inside(instance, rays[static_cast<std::size_t>(std::countr_zero(active))])); // of all not active
        for (unsigned some = active & (active - 1); some != 0; some &= some - 1) {
            const auto ray = static_cast<std::size_t>(std::countr_zero(some));
            its[ray] = scene.inside(instance, rays[ray]);
        }
        const RayPacket packet(its, shape.bounds);
        if (packet.coherent()) {
            PacketTraversal(shape, packet, its, active, instance.object, NoInstances(), best).run();
            return;
        }
        for (; active != 0; active &= active - 1) {
            const auto ray = static_cast<std::size_t>(std::countr_zero(active));
            Hit hit = best.get(ray);
            scene.instance_test<false>(rays[ray])(instance, hit);
            best.set(ray, hit);
        }
    }
};

// Whole surfaces and holes alike.
Hit Accelerator::first(const Ray& ray) const {
    Hit best;
    best.t = min(ray.t_max, std::numeric_limits<float>::max()); // a distance that overflowed is none
    if (!traceable(ray)) return {};
    return find_closest(world_, ray, kNoObject, best, instance_test<false>(ray)) ? best : Hit{};
}

Hit Accelerator::closest(const Ray& ray) const {
    const Hit hit = first(ray);
    return holes_ ? beyond_holes(ray, hit) : hit;
}

// From a hit on to the first that the ray does not pass through. Every hit lies beyond the last, so there is an end.
Hit Accelerator::beyond_holes(const Ray& ray, Hit hit) const {
    Ray rest = ray;
    while (hit.valid() && passes_through(scene_, ray, hit)) {
        rest.t_min = hit.t;
        hit = first(rest);
    }
    return hit;
}

// As find_any has it, but by way of the nearest hits.
bool Accelerator::occluded_beyond_holes(Ray ray, const Hit& end) const {
    ray.t_max = min(ray.t_max, end.t);
    const auto before_end = [&](const Hit& hit) {
        return hit.valid() &&
               (hit.t < end.t || std::pair(hit.object, hit.primitive) < std::pair(end.object, end.primitive));
    };
    for (Hit hit = first(ray); before_end(hit); hit = first(ray)) {
        const bool is_end = hit.object == end.object && hit.primitive == end.primitive;
        if (!is_end && !passes_through(scene_, ray, hit)) return true;
        ray.t_min = hit.t;
    }
    return false;
}

void Accelerator::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    constexpr std::size_t kSize = RayPacket::kSize;
    constexpr unsigned kAll = (1u << kSize) - 1;
    const RayPacket::Batch most(std::numeric_limits<float>::max()); // a distance that overflowed is none
    std::size_t done = 0;
    for (; rays.size() - done >= kSize; done += kSize) {
        const auto some = rays.subspan(done).first<kSize>();
        const auto their_hits = hits.subspan(done).first<kSize>();
        const RayPacket packet(some, world_.bounds);
        if (!packet.coherent()) {
            for (std::size_t i = 0; i < kSize; ++i) their_hits[i] = first(some[i]);
            continue;
        }
        PacketHits best(xsimd::min(packet.t_max(), most));
        PacketTraversal(world_, packet, some, kAll, kNoObject, PacketInstances{*this, some}, best).run();
        best.store(their_hits);
    }
    for (; done < rays.size(); ++done) hits[done] = first(rays[done]);
    if (holes_)
        for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = beyond_holes(rays[i], hits[i]);
}

namespace {

// Rays that are sheared along the same axes: the main one, and which way they run along it. Of others 6.
std::size_t shear_class(const Ray& ray) {
    if (!traceable(ray) || ray.t_min != ray.t_min || ray.t_max != ray.t_max) return 6;
    const Vec3 size = abs(ray.direction); // as longest_axis, without a branch
    const bool x = (size.x >= size.y) & (size.x >= size.z), y = !x & (size.y >= size.z);
    const std::array<float, 3> d{ray.direction.x, ray.direction.y, ray.direction.z};
    const std::size_t axis = x ? 0 : 2 - std::size_t{y};
    return axis + (d[axis] < 0 ? 3 : 0);
}

// So many rays are sorted at a time.
constexpr std::size_t kMostSorted = 512;

// The indices of some rays, class after class.
struct ByClass {
    ByClass(std::span<const Ray> rays, std::span<const std::uint32_t> which) {
        std::array<std::uint8_t, kMostSorted> classes;
        std::array<std::size_t, 7> next{};
        for (std::size_t i = 0; i < which.size(); ++i)
            ++next[classes[i] = static_cast<std::uint8_t>(shear_class(rays[which[i]]))];
        std::size_t begin = 0;
        for (std::size_t& count : next) begin += std::exchange(count, begin);
        for (std::size_t i = 0; i < which.size(); ++i) order[next[classes[i]]++] = which[i];
        ends = next;
    }
    std::array<std::uint32_t, kMostSorted> order;
    std::array<std::size_t, 7> ends; ///< of each class in it
};

} // namespace

// Rays sheared alike, up to a packet of them, however they run otherwise: all primitives are tested.
void Accelerator::closest_in_list(std::span<const Ray> rays, std::span<const std::uint32_t> which, std::span<Hit> hits) const {
    constexpr std::size_t kSize = RayPacket::kSize;
    std::array<Ray, kSize> some;
    for (std::size_t k = 0; k < kSize; ++k) some[k] = rays[which[k < which.size() ? k : 0]];
    const RayPacket packet{std::span<const Ray, kSize>(some)};
    if (which.size() < kSize / 4 || !packet.coherent()) {
        for (const std::uint32_t i : which) hits[i] = first(rays[i]);
        return;
    }
    PacketHits best(xsimd::min(packet.t_max(), RayPacket::Batch(std::numeric_limits<float>::max())));
    const PacketInstances none{*this, some};
    PacketTraversal(world_, packet, some, (1u << which.size()) - 1, kNoObject, none, best).run_list();
    std::array<Hit, kSize> found;
    best.store(found);
    for (std::size_t k = 0; k < which.size(); ++k) hits[which[k]] = found[k];
}

void Accelerator::closest_of_scattered(std::span<const Ray> rays, std::span<const std::uint32_t> which,
                                       std::span<Hit> hits) const {
    const std::size_t most = streams_ ? RayStream::kSize : kMostSorted;
    for (std::size_t from = 0; from < which.size(); from += most) {
        const auto some = which.subspan(from, std::min(which.size() - from, most));
        if (streams_)
            RayStream(world_, rays, some, hits).run();
        else
            closest_by_class(rays, some, hits);
    }
    if (holes_)
        for (const std::uint32_t i : which) hits[i] = beyond_holes(rays[i], hits[i]);
}

void Accelerator::closest_by_class(std::span<const Ray> rays, std::span<const std::uint32_t> which, std::span<Hit> hits) const {
    const ByClass sorted(rays, which);
    std::size_t done = 0;
    for (std::size_t c = 0; c < 6; ++c)
        while (done < sorted.ends[c]) {
            const std::size_t taken = std::min(RayPacket::kSize, sorted.ends[c] - done);
            closest_in_list(rays, std::span(sorted.order).subspan(done, taken), hits);
            done += taken;
        }
    for (; done < which.size(); ++done) hits[sorted.order[done]] = first(rays[sorted.order[done]]);
}

bool Accelerator::occluded(const Ray& ray, const Hit& end) const {
    Hit clamped = end;
    clamped.t = min(end.t, std::numeric_limits<float>::max()); // as above
    if (holes_) return occluded_beyond_holes(ray, clamped);
    return traceable(ray) && find_any(world_, ray, kNoObject, clamped, instance_test<true>(ray));
}

HierarchyStatistics Accelerator::statistics() const {
    HierarchyStatistics result;
    result.quality = quality_ == BvhQuality::kHigh ? "high" : "default";
    const auto add = [&](const Bvh& bvh) {
        result.nodes += static_cast<std::int64_t>(bvh.nodes.size());
        result.references += static_cast<std::int64_t>(bvh.references);
    };
    add(world_);
    for (const Bvh& shape : shapes_) add(shape);
    return result;
}

std::int64_t Accelerator::memory_bytes() const {
    std::int64_t sum = world_.memory_bytes();
    for (const Bvh& shape : shapes_) sum += shape.memory_bytes();
    return sum;
}

} // namespace duet::raytrace

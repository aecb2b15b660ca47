#include "raytrace/acceleration/accelerator.h"

#include "common/vec/robust.h"
#include "raytrace/acceleration/bvh_build.h"
#include "raytrace/acceleration/bvh_optimize.h"
#include "raytrace/acceleration/bvh_packet.h"
#include "raytrace/acceleration/bvh_traverse.h"

#include <algorithm>
#include <span>

namespace duet::raytrace {

namespace {

// Gathers primitives of all kinds with their boxes, then makes a hierarchy of them.
class Gatherer {
public:
    void add_shape(const Shape& shape, std::uint32_t object) {
        if (const auto* mesh = std::get_if<Mesh>(&shape)) {
            for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) {
                const auto& [a, b, c] = mesh->triangles[i];
                add_triangle({mesh->positions[a], mesh->positions[b], mesh->positions[c], object, i});
            }
        } else if (const auto* list = std::get_if<QuadList>(&shape)) {
            for (std::uint32_t i = 0; i < list->quads.size(); ++i) add_quad({list->quads[i], object, i});
        } else {
            add(PrimitiveKind::kSphere, bounds(shape, Mat4()), spheres_, BvhSphere{std::get<Sphere>(shape), object, 0});
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
        add(PrimitiveKind::kInstance, box, instances_, BvhInstance{index, object.shape});
    }

    Bvh build(int threads) {
        BinaryTree tree = build_binary_tree(std::move(items_), threads);
        if (getenv("PART")) reinsert(tree, (float)atof(getenv("PART")), getenv("ROUNDS") ? atoi(getenv("ROUNDS")) : 1, threads);
        Collapsed collapsed = collapse(tree);
        Bvh& bvh = collapsed.bvh;
        bvh.triangles.reserve(collapsed.elements[static_cast<std::size_t>(PrimitiveKind::kTriangle)]);
        for (const LeafItems& leaf : collapsed.leaves) {
            const std::span items(tree.items.data() + leaf.first, leaf.count);
            switch (items[0].kind) {
            case PrimitiveKind::kTriangle:
                bvh.triangles.push_back(block(items));
                break;
            case PrimitiveKind::kQuad:
                for (const BuildItem& item : items) bvh.quads.push_back(quads_[item.index]);
                break;
            case PrimitiveKind::kSphere:
                for (const BuildItem& item : items) bvh.spheres.push_back(spheres_[item.index]);
                break;
            case PrimitiveKind::kInstance:
                for (const BuildItem& item : items) bvh.instances.push_back(instances_[item.index]);
                break;
            }
        }
        return std::move(bvh);
    }

private:
    struct Triangle {
        Vec3 a, b, c;
        std::uint32_t object, primitive;
    };

    TriangleBlock block(std::span<const BuildItem> items) const {
        TriangleBlock result;
        for (auto& corner : result.corner)
            for (auto& axis : corner) axis.fill(std::numeric_limits<float>::quiet_NaN());
        result.object.fill(kNoObject);
        result.primitive.fill(0);
        for (std::size_t i = 0; i < items.size(); ++i) {
            const Triangle& t = triangles_[items[i].index];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                result.corner[0][axis][i] = t.a[axis];
                result.corner[1][axis][i] = t.b[axis];
                result.corner[2][axis][i] = t.c[axis];
            }
            result.object[i] = t.object;
            result.primitive[i] = t.primitive;
        }
        return result;
    }

    void add_triangle(const Triangle& triangle) {
        Box3 box;
        for (const Vec3& p : {triangle.a, triangle.b, triangle.c}) box.extend(p);
        add(PrimitiveKind::kTriangle, box, triangles_, triangle);
    }
    void add_quad(const BvhQuad& quad) {
        Box3 box;
        for (const Vec3& p : corners(quad.quad)) box.extend(p);
        add(PrimitiveKind::kQuad, box, quads_, quad);
    }
    template <typename Primitive>
    void add(PrimitiveKind kind, const Box3& box, std::vector<Primitive>& list, const Primitive& primitive) {
        items_.push_back({box, static_cast<std::uint32_t>(list.size()), kind});
        list.push_back(primitive);
    }

    std::vector<BuildItem> items_;
    std::vector<Triangle> triangles_;
    std::vector<BvhQuad> quads_;
    std::vector<BvhSphere> spheres_;
    std::vector<BvhInstance> instances_;
};

bool stands_in_world(const Object& object) { return object.identity && !object.moving; }

} // namespace

Accelerator::Accelerator(const Scene& scene, int threads) : scene_(scene), shapes_(scene.shapes.size()) {
    Gatherer world;
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
        Gatherer own;
        own.add_shape(shape, kNoObject);
        shapes_[object.shape] = own.build(threads);
    }
    world_ = world.build(threads);
}

// What an instance's hits are in its shape's hierarchy.
template <bool kAny> auto Accelerator::instance_test(const Ray& ray) const {
    return [this, &ray](const BvhInstance& instance, Hit& so_far) {
        const auto no_instance = [](const BvhInstance&, Hit&) { return false; };
        const Object& object = scene_.objects[instance.object];
        Ray inside;
        if (object.moving) {
            const ObjectTransform transform = object_transform(object, ray.time);
            inside = to_object_space(ray, transform.to_world, transform.to_object);
        } else {
            inside = to_object_space(ray, object.to_world, object.to_object);
        }
        if (!traceable(inside)) return false;
        const Bvh& shape = shapes_[instance.shape];
        if constexpr (kAny)
            return find_any(shape, inside, instance.object, so_far, no_instance);
        else
            return find_closest(shape, inside, instance.object, so_far, no_instance);
    };
}

Hit Accelerator::closest(const Ray& ray) const {
    Hit best;
    best.t = min(ray.t_max, std::numeric_limits<float>::max()); // a distance that overflowed is none
    if (!traceable(ray)) return {};
    return find_closest(world_, ray, kNoObject, best, instance_test<false>(ray)) ? best : Hit{};
}

void Accelerator::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    constexpr std::size_t kSize = RayPacket::kSize;
    const auto instance = [this](const Ray& ray) { return instance_test<false>(ray); };
    std::size_t done = 0;
    for (; rays.size() - done >= kSize; done += kSize) {
        const auto some = rays.subspan(done).first<kSize>();
        const auto their_hits = hits.subspan(done).first<kSize>();
        const RayPacket packet(some, world_.bounds);
        if (!packet.coherent()) {
            for (std::size_t i = 0; i < kSize; ++i) their_hits[i] = closest(some[i]);
            continue;
        }
        PacketTraversal(world_, packet, some, instance).run(their_hits);
    }
    for (; done < rays.size(); ++done) hits[done] = closest(rays[done]);
}

bool Accelerator::occluded(const Ray& ray, const Hit& end) const {
    return traceable(ray) && find_any(world_, ray, kNoObject, end, instance_test<true>(ray));
}

std::int64_t Accelerator::memory_bytes() const {
    std::int64_t sum = world_.memory_bytes();
    for (const Bvh& shape : shapes_) sum += shape.memory_bytes();
    return sum;
}

} // namespace duet::raytrace

#include "raytrace/acceleration/accelerator.h"

#include "common/scene/shared_mesh.h"
#include "raytrace/acceleration/bvh_input.h"
#include "raytrace/acceleration/bvh_packet.h"
#include "raytrace/acceleration/sort_by_class.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

namespace duet::raytrace {

namespace {

bool is_untransformed(const Object& object) { return object.identity && !object.moving; }

} // namespace

Accelerator::Accelerator(const Scene& scene, int threads, const Accelerator* before)
    : scene_(scene), seen_through_(scene.shapes.size()), shapes_(scene.shapes.size()),
      has_alpha_masks_(scene.needs.alpha) {
    for (const Object& object : scene.objects)
        if (can_be_seen_through(scene, object)) seen_through_[object.shape] = true;
    BvhInput world(threads);
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const Shape& shape = scene.shapes[object.shape];
        primitives_ += primitive_count(shape);
        if (is_untransformed(object) && !(before != nullptr && std::holds_alternative<Mesh>(shape))) {
            world.add_shape(shape, i, seen_through_[object.shape]);
            continue;
        }
        world.add_instance(object, i, shape);
        std::shared_ptr<const Bvh>& own = shapes_[object.shape];
        const bool seen_through = seen_through_[object.shape];
        if (!own && before != nullptr) own = before->hierarchy_for(scene, object.shape, seen_through);
        if (own) continue;
        BvhInput input(threads);
        input.add_shape(shape, kNoObject, seen_through);
        own = std::make_shared<const Bvh>(input.build());
    }
    world_ = world.build();
    few_primitives_ = !world_.use_tree() && world_.instances.empty() && !has_alpha_masks_;
}

// Returns the hierarchy of a shape of another scene, or null if this scene has none for it.
std::shared_ptr<const Bvh> Accelerator::hierarchy_for(const Scene& scene, std::uint32_t shape,
                                                      bool seen_through) const {
    const auto own = shared_mesh(scene_, scene, shape);
    return own && seen_through_[*own] == seen_through ? shapes_[*own] : nullptr;
}

// Transforms the ray to the instance's object space at the ray's time.
Ray Accelerator::to_instance_space(const BvhInstance& instance, const Ray& ray) const {
    const Object& object = scene_.objects[instance.object];
    if (!object.moving) return to_object_space(ray, object.to_world, object.to_object);
    const ObjectTransform transform = object_transform(object, ray.time);
    return to_object_space(ray, transform.to_world, transform.to_object);
}

// Returns the instance test of a ray: it traverses the bottom-level BVH of the instance's shape.
template <bool kAny> auto Accelerator::instance_test(const Ray& ray, const AlphaFilter* alpha) const {
    return [this, &ray, alpha](const BvhInstance& instance, Hit& so_far) {
        const auto no_instance = [](const BvhInstance&, Hit&) { return false; };
        const Ray local = to_instance_space(instance, ray);
        if (!traceable(local)) return false;
        const Bvh& shape = *shapes_[instance.shape];
        return traverse<kAny>(shape, local, instance.object, so_far, no_instance, alpha);
    };
}

// Tests instances against a whole packet; operator()(ray) returns the test for a single ray.
struct Accelerator::PacketInstances {
    static constexpr std::size_t kSize = RayPacket::kSize;
    const Accelerator& scene;
    std::span<const Ray, kSize> rays;

    auto operator()(const Ray& ray) const { return scene.instance_test<false>(ray, nullptr); }

    void operator()(const BvhInstance& instance, unsigned active, PacketHits& best) const {
        const Bvh& shape = *scene.shapes_[instance.shape];
        std::array<Ray, kSize> local;
        // Lanes that are not active get the ray of the first active one.
        local.fill(scene.to_instance_space(instance, rays[static_cast<std::size_t>(std::countr_zero(active))]));
        for (const std::size_t ray : SetBits(active & (active - 1))) {
            local[ray] = scene.to_instance_space(instance, rays[ray]);
        }
        const RayPacket packet(local, shape.bounds);
        if (packet.coherent()) {
            PacketTraversal(shape, packet, local, active, instance.object, NoInstances(), best).run();
            return;
        }
        for (const std::size_t ray : SetBits(active)) {
            Hit hit = best.get(ray);
            scene.instance_test<false>(rays[ray], nullptr)(instance, hit);
            best.set(ray, hit);
        }
    }
};

// Traverses all hierarchies in the same way as `traverse`. A distance that overflowed is no hit.
template <bool kAny> bool Accelerator::trace(const Ray& ray, Hit& best) const {
    best.t = min(best.t, std::numeric_limits<float>::max());
    if (!traceable(ray)) return false;
    const AlphaFilter filter{scene_, ray};
    const AlphaFilter* alpha = has_alpha_masks_ ? &filter : nullptr;
    return traverse<kAny>(world_, ray, kNoObject, best, instance_test<kAny>(ray, alpha), alpha);
}

Hit Accelerator::closest(const Ray& ray) const {
    Hit best;
    best.t = ray.t_max;
    return trace<false>(ray, best) ? best : Hit{};
}

bool Accelerator::occluded(const Ray& ray, const Hit& end) const {
    Hit clamped = end;
    return trace<true>(ray, clamped);
}

void Accelerator::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    constexpr std::size_t kSize = RayPacket::kSize;
    constexpr unsigned kAll = (1u << kSize) - 1;
    const RayPacket::Batch max_distance(std::numeric_limits<float>::max()); // a distance that overflowed is no hit
    std::size_t done = 0;
    for (; rays.size() - done >= kSize; done += kSize) {
        const auto some = rays.subspan(done).first<kSize>();
        const auto their_hits = hits.subspan(done).first<kSize>();
        const RayPacket packet(some, world_.bounds);
        if (!packet.coherent()) {
            for (std::size_t i = 0; i < kSize; ++i) their_hits[i] = closest(some[i]);
            continue;
        }
        PacketHits best(xsimd::min(packet.t_max(), max_distance));
        PacketTraversal(world_, packet, some, kAll, kNoObject, PacketInstances{*this, some}, best).run();
        best.store(their_hits);
        if (!has_alpha_masks_) continue; // packet traversal ignores alpha masks
        for (std::size_t i = 0; i < kSize; ++i)
            if (their_hits[i].valid() && passes_alpha_mask(scene_, some[i], their_hits[i]))
                their_hits[i] = closest(some[i]);
    }
    for (; done < rays.size(); ++done) hits[done] = closest(rays[done]);
}

namespace {

// Returns the shear class of a ray: its dominant axis, and whether it points in the negative direction along it.
// Rays that cannot be traced get the last class.
constexpr std::size_t kShearClasses = 7;
std::size_t shear_class(const Ray& ray) {
    if (!traceable(ray) || ray.t_min != ray.t_min || ray.t_max != ray.t_max) return kShearClasses - 1;
    const Vec3 size = abs(ray.direction); // as in longest_axis(), but without a branch
    const bool x = (size.x >= size.y) & (size.x >= size.z), y = !x & (size.y >= size.z);
    const std::array<float, 3> d{ray.direction.x, ray.direction.y, ray.direction.z};
    const std::size_t axis = x ? 0 : 2 - std::size_t{y};
    return axis + (d[axis] < 0 ? 3 : 0);
}

// Rays are sorted by class in chunks of at most this size.
constexpr std::size_t kMaxSorted = 512;

} // namespace

// Tests up to one packet of rays of the same shear class against the whole primitive list. The rays may otherwise be
// incoherent.
void Accelerator::closest_in_list(std::span<const Ray> rays, std::span<const std::uint32_t> indices,
                                  std::span<Hit> hits) const {
    constexpr std::size_t kSize = RayPacket::kSize;
    std::array<Ray, kSize> some;
    for (std::size_t k = 0; k < kSize; ++k) some[k] = rays[indices[k < indices.size() ? k : 0]];
    const RayPacket packet{std::span<const Ray, kSize>(some)};
    if (indices.size() < kSize / 4 || !packet.coherent()) {
        for (const std::uint32_t i : indices) hits[i] = closest(rays[i]);
        return;
    }
    PacketHits best(xsimd::min(packet.t_max(), RayPacket::Batch(std::numeric_limits<float>::max())));
    const PacketInstances none{*this, some};
    PacketTraversal(world_, packet, some, (1u << indices.size()) - 1, kNoObject, none, best).run_list();
    std::array<Hit, kSize> found;
    best.store(found);
    for (std::size_t k = 0; k < indices.size(); ++k) hits[indices[k]] = found[k];
}

void Accelerator::closest_of_incoherent(std::span<const Ray> rays, std::span<const std::uint32_t> indices,
                                        std::span<Hit> hits) const {
    if (few_primitives_)
        for (std::size_t from = 0; from < indices.size(); from += kMaxSorted)
            closest_sorted_by_class(rays, indices.subspan(from, std::min(indices.size() - from, kMaxSorted)), hits);
    else
        for (const std::uint32_t i : indices) hits[i] = closest(rays[i]);
}

void Accelerator::closest_sorted_by_class(std::span<const Ray> rays, std::span<const std::uint32_t> indices,
                                          std::span<Hit> hits) const {
    std::array<std::uint8_t, kMaxSorted> classes;
    std::array<std::uint32_t, kMaxSorted> order;
    const auto ends = sort_by_class<kShearClasses>(
        indices, [&](std::uint32_t i) { return shear_class(rays[i]); }, classes, order);
    std::size_t done = 0;
    for (std::size_t c = 0; c < kShearClasses - 1; ++c)
        while (done < ends[c]) {
            const std::size_t taken = std::min(RayPacket::kSize, ends[c] - done);
            closest_in_list(rays, std::span(order).subspan(done, taken), hits);
            done += taken;
        }
    for (; done < indices.size(); ++done) hits[order[done]] = closest(rays[order[done]]);
}

BvhStatistics Accelerator::statistics() const {
    BvhStatistics result;
    const auto add = [&](const Bvh& bvh) {
        result.nodes += static_cast<std::int64_t>(bvh.nodes.size());
        result.references += static_cast<std::int64_t>(bvh.references);
    };
    add(world_);
    for (const auto& shape : shapes_)
        if (shape) add(*shape);
    return result;
}

std::int64_t Accelerator::memory_bytes() const {
    std::int64_t sum = world_.memory_bytes();
    for (const auto& shape : shapes_)
        if (shape) sum += shape->memory_bytes();
    return sum;
}

} // namespace duet::raytrace

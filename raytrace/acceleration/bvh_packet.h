// Declares PacketTraversal, which traverses a hierarchy with a packet of coherent rays. Each box and each triangle is
// loaded once and tested against all rays. The hits are bit-equal to those of `traverse<false>`.
#pragma once

#include "raytrace/acceleration/ray_packet.h"

#include <span>

namespace duet::raytrace {

/// Provides the corners of a block's polygons. With kRelative they are differences from the origin that all rays
/// share, computed once for all rays.
template <std::size_t kCorners, bool kRelative> class BlockCorners {
public:
    using Batch = RayPacket::Batch;
    using Axes = std::array<BlockLanes<float>, 3>;

    explicit BlockCorners(const std::array<Axes, kCorners>& corners) : corners_(corners) {}

    /// Returns the corners of the polygon in one lane, to be tested against all rays.
    auto of(std::size_t lane) const {
        return each(std::make_index_sequence<kCorners>(), [&](const Axes& axes) { return Single{&axes, lane}; });
    }
    /// Returns the corners of all polygons, repeated for each ray of a batch in which a ray takes kBlockSize lanes.
    auto of_all() const {
        return each(std::make_index_sequence<kCorners>(), [&](const Axes& axes) { return Repeated{&axes}; });
    }

private:
    struct Single {
        const Axes* axes;
        std::size_t lane;
        float operator[](std::size_t axis) const { return (*axes)[axis][lane]; }
    };
    struct Repeated {
        const Axes* axes;
        Batch operator[](std::size_t axis) const { return repeated<RayPacket::kSize>((*axes)[axis]); }
    };
    template <std::size_t... i, typename Make> auto each(std::index_sequence<i...>, const Make& make) const {
        if constexpr (kRelative)
            return std::array{RelativeVertex<decltype(make(corners_[i]))>{make(corners_[i])}...};
        else
            return std::array{make(corners_[i])...};
    }

    const std::array<Axes, kCorners>& corners_;
};

/// Replaces the instance tests in a hierarchy without instances.
struct NoInstances {
    auto operator()(const Ray&) const {
        return [](const BvhInstance&, Hit&) { return false; };
    }
    void operator()(const BvhInstance&, unsigned, PacketHits&) const {}
};

/// Finds the closest hits of a coherent packet's rays, as `traverse<false>` does for each.
template <typename Instances> class PacketTraversal {
public:
    static constexpr std::size_t kSize = RayPacket::kSize;

    /// `active` is a bit mask of the rays to trace. If `object` is not kNoObject (inside an instance), hits report it
    /// as their object. instances(ray) returns the instance test that `traverse<false>` needs for one ray;
    /// instances(instance, rays, best) tests an instance against several rays.
    PacketTraversal(const Bvh& bvh, const RayPacket& packet, std::span<const Ray, kSize> rays, unsigned active,
                    std::uint32_t object, const Instances& instances, PacketHits& best)
        : bvh_(bvh), packet_(packet), rays_(rays), active_(active), object_(object), instances_(instances), best_(best),
          farthest_(reduce_max(ends())) {}

    void run() {
        if (bvh_.nodes.empty())
            run_list();
        else
            traverse();
    }
    /// Tests all leaves of the list. The packet may be one constructed without bounds.
    void run_list() {
        for (const BvhRef leaf : bvh_.list) test_leaf(leaf, active_);
    }

private:
    using Batch = RayPacket::Batch;
    // If at most this many rays are active, they are tested, a few at a time, against a whole block of polygons. More
    // active rays are all tested against one polygon at a time.
    static constexpr int kMaxRaysPerBlockTest = kSize / 2;
    // If at least this many rays are active, they are all tested against one sphere at a time. Fewer are each tested
    // against a whole block of spheres.
    static constexpr int kMinRaysPerSphereTest = 3;
    // This is the number of rays that are tested together against a block. Each takes kBlockSize lanes.
    static constexpr std::size_t kRaysPerBatch = kSize / kBlockSize;

    // Stores a child on the traversal stack, with the distance at which each ray enters its box.
    struct PacketStackEntry {
        alignas(sizeof(Batch)) RayPacket::Values entry; // infinity for rays that miss the box
        float nearest;
        unsigned entering; // bit mask of the rays that enter
        BvhRef child;
    };

    void traverse() {
        BvhRef next = BvhRef::node(0);
        unsigned active = active_;
        for (;;) {
            while (active != 0 && !next.is_leaf()) active = step(next);
            if (active != 0) test_leaf(next, active);
            do {
                if (size_ == 0) return;
                --size_;
                active = lane_bits(Batch::load_aligned(stack_[size_].entry.data()) <= ends()) & active_;
            } while (active == 0);
            next = stack_[size_].child;
        }
    }

    // Steps from the node `next` to its nearest child that any ray enters, and pushes the other children. Returns a
    // bit mask of the rays that enter that child, or 0 if there is no such child.
    unsigned step(BvhRef& next) {
        const BvhNode& node = node_at(bvh_, next);
        const auto [distance, entered] = packet_.enter_any(node, farthest_);
        if (entered == 0) return 0;
        for (const std::size_t child : SetBits(entered)) prefetch(bvh_, node.children[child]);
        const Lanes nearest(distance);
        const std::size_t bottom = size_;
        for (const std::size_t child : SetBits(entered)) {
            const auto [entry, enters] = packet_.enter(node, child, ends());
            const unsigned rays = lane_bits(enters) & active_;
            if (rays == 0) continue;
            std::size_t i = size_++;
            for (; i > bottom && stack_[i - 1].nearest < nearest[child]; --i) stack_[i] = stack_[i - 1];
            xsimd::select(enters, entry, Batch(kInfinity)).store_aligned(stack_[i].entry.data());
            stack_[i].nearest = nearest[child];
            stack_[i].entering = rays;
            stack_[i].child = node.children[child];
        }
        if (size_ == bottom) return 0;
        --size_;
        next = stack_[size_].child;
        return stack_[size_].entering;
    }

    void test_leaf(BvhRef leaf, unsigned active) {
        if (leaf.kind() == PrimitiveKind::kTriangle) {
            test(bvh_.triangles[leaf.index()], active);
        } else if (leaf.kind() == PrimitiveKind::kQuad) {
            test(bvh_.quads[leaf.index()], active);
        } else if (leaf.kind() == PrimitiveKind::kInstance && std::popcount(active) > kMaxRaysPerBlockTest) {
            instances_(bvh_.instances[leaf.index()], active, best_);
            best_changed_ = true;
        } else if (leaf.kind() == PrimitiveKind::kSphere && std::popcount(active) >= kMinRaysPerSphereTest) {
            test(bvh_.spheres[leaf.index()], active);
        } else {
            for (const std::size_t ray : SetBits(active)) {
                const auto instance = instances_(rays_[ray]);
                Hit hit = best_.get(ray);
                LeafTest<false, decltype(instance)>(bvh_, rays_[ray], object_, instance)(leaf, hit);
                set_best(ray, hit);
            }
        }
        if (best_changed_) farthest_ = reduce_max(ends());
        best_changed_ = false;
    }

    template <std::size_t kCorners> void test(const PolygonBlock<kCorners>& block, unsigned active) {
        if (const auto& origin = packet_.origin()) {
            using Boxes = FloatBatch<kBlockSize>;
            alignas(sizeof(Boxes)) std::array<typename BlockCorners<kCorners, true>::Axes, kCorners> differences;
            for (std::size_t i = 0; i < kCorners; ++i)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    (Boxes::load_aligned(block.corner[i][axis].data()) - Boxes((*origin)[axis]))
                        .store_aligned(differences[i][axis].data());
            test(block, BlockCorners<kCorners, true>(differences), active);
        } else {
            test(block, BlockCorners<kCorners, false>(block.corner), active);
        }
    }
    template <std::size_t kCorners, typename Corners>
    [[gnu::always_inline]] void test(const PolygonBlock<kCorners>& block, const Corners& corners, unsigned active) {
        if (std::popcount(active) <= kMaxRaysPerBlockTest)
            test_block(block, corners, active);
        else
            test_each_polygon(block, corners, active);
    }

    // Tests a whole block against kRaysPerBatch rays at a time, as many as fit into a batch.
    template <std::size_t kCorners, typename Corners>
    void test_block(const PolygonBlock<kCorners>& block, const Corners& corners, unsigned active) {
        const auto vertices = corners.of_all();
        while (active != 0) {
            std::array<std::size_t, kRaysPerBatch> rays;
            unsigned repeated_lanes = 0; // lanes that repeat the first ray, because too few are left
            for (std::size_t i = 0; i < kRaysPerBatch; ++i) {
                if (active == 0) repeated_lanes |= ((1u << kBlockSize) - 1) << (i * kBlockSize);
                rays[i] = active != 0 ? static_cast<std::size_t>(std::countr_zero(active)) : rays[0];
                active &= active - 1;
            }
            const CandidateTest<Batch> test(packet_.shears(rays), vertices, RayPacket::lanes_of(best_.t, rays));
            unsigned candidates = test.candidates() & ~repeated_lanes;
            if (candidates == 0) continue;
            const Lanes t(test.t()), u(test.u()), v(test.v());
            for (const std::size_t i : SetBits(candidates)) {
                const std::size_t lane = i % kBlockSize, ray = rays[i / kBlockSize];
                if (!(test.certain() >> i & 1))
                    consider_exactly(block, lane, ray);
                else if (t[i] > rays_[ray].t_min && t[i] <= best_.t[ray])
                    consider(block, lane, ray, {t[i], u[i], v[i]});
            }
        }
    }

    // Tests one polygon at a time against all rays.
    template <std::size_t kCorners, typename Corners>
    void test_each_polygon(const PolygonBlock<kCorners>& block, const Corners& corners, unsigned active) {
        for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
            const float x = block.corner[0][0][lane];
            if (x != x) return; // this lane and all after it are unused
            const CandidateTest<Batch> test(packet_.shear(), corners.of(lane), ends());
            const unsigned candidates = test.candidates() & active;
            if (candidates == 0) continue;
            const unsigned nearer = lane_bits((test.t() > packet_.t_min()) & (test.t() < ends()));
            const unsigned ties = lane_bits((test.t() > packet_.t_min()) & (test.t() == ends()));
            const unsigned certain = test.certain() & candidates;
            if ((certain & nearer) != 0)
                store_hits(certain & nearer, test.t(), test.u(), test.v(), block.object[lane], block.primitive[lane]);
            if ((certain & ties) != 0) consider_each(certain & ties, block, lane, test);
            const unsigned needs_distance = test.needs_distance();
            if ((needs_distance & candidates) != 0)
                consider_with_distance(needs_distance & candidates, block, lane, test);
            for (const std::size_t ray : SetBits(candidates & ~certain & ~needs_distance))
                consider_exactly(block, lane, ray);
        }
    }

    // Tests one sphere at a time, in double precision, against the rays that a conservative filter in float does not
    // reject.
    [[gnu::noinline]] void test(const SphereBlock& block, unsigned active) {
        const SphereFilter filter(packet_.lines());
        for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
            const Sphere sphere = block.sphere(lane);
            if (sphere.radius != sphere.radius) return; // this lane and all after it are unused
            const unsigned candidates = filter.may_hit(sphere) & active;
            if (candidates == 0) continue;
            const SphereRaysTest test(packet_.lines(), candidates, sphere, packet_.t_min(), ends());
            const unsigned nearer = test.hits() & lane_bits(test.t() < ends());
            const Batch zero(0.0f);
            const Lanes t(test.t());
            for (const std::size_t ray : SetBits(test.hits() & ~nearer)) {
                consider(ray, {reported_object(block.object[lane]), 0, 0, 0, t[ray]});
            }
            if (nearer != 0) store_hits(nearer, test.t(), zero, zero, block.object[lane], 0);
        }
    }

    // Stores the given hits as the best hits of the rays.
    void store_hits(unsigned rays, Batch t, Batch u, Batch v, std::uint32_t object, std::uint32_t primitive) {
        best_changed_ = true;
        store_lanes(t, rays, best_.t.data());
        store_lanes(u, rays, best_.u.data());
        store_lanes(v, rays, best_.v.data());
        store_lanes(reported_object(object), rays, best_.object);
        store_lanes(primitive, rays, best_.primitive);
    }
    template <typename Block>
    void consider_each(unsigned rays, const Block& block, std::size_t lane, const CandidateTest<Batch>& test) {
        const Lanes t(test.t()), u(test.u()), v(test.v());
        for (const std::size_t ray : SetBits(rays)) {
            consider(block, lane, ray, {t[ray], u[ray], v[ray]});
        }
    }
    // Computes the missing hit distance of rays that start close to a polygon. Most of these rays leave it.
    template <std::size_t kCorners>
    [[gnu::noinline]] void consider_with_distance(unsigned rays, const PolygonBlock<kCorners>& block, std::size_t lane,
                                                  const CandidateTest<Batch>& test) {
        const Lanes u(test.u()), v(test.v());
        const unsigned first_half = kCorners == 3 ? ~0u : lane_bits(test.first_half());
        const auto corners = block.corners(lane);
        for (const std::size_t ray : SetBits(rays)) {
            const std::size_t second = (first_half >> ray & 1u) != 0 ? 1 : 2;
            const float t = static_cast<float>(plane_distance(Vec3d(rays_[ray].origin), Vec3d(rays_[ray].direction),
                                                              Vec3d(corners[0]), Vec3d(corners[second]),
                                                              Vec3d(corners[second + 1])));
            if (t > rays_[ray].t_min && t <= best_.t[ray]) consider(block, lane, ray, {t, u[ray], v[ray]});
        }
    }
    template <typename Block> void consider_exactly(const Block& block, std::size_t lane, std::size_t ray) {
        Ray ended = rays_[ray];
        ended.t_max = best_.t[ray];
        if (const auto hit = exact_hit(ShearedRay(ended), block, lane)) consider(block, lane, ray, *hit);
    }
    template <typename Block>
    void consider(const Block& block, std::size_t lane, std::size_t ray, const TriangleHit& hit) {
        consider(ray, {reported_object(block.object[lane]), block.primitive[lane], hit.u, hit.v, hit.t});
    }
    void consider(std::size_t ray, const Hit& found) {
        if (precedes(found, best_.get(ray))) set_best(ray, found);
    }

    void set_best(std::size_t ray, const Hit& hit) {
        best_.set(ray, hit);
        best_changed_ = true;
    }
    Batch ends() const { return Batch::load_aligned(best_.t.data()); }
    std::uint32_t reported_object(std::uint32_t own) const { return object_ == kNoObject ? own : object_; }

    const Bvh& bvh_;
    const RayPacket& packet_;
    std::span<const Ray, kSize> rays_;
    unsigned active_;
    std::uint32_t object_;
    const Instances& instances_;
    PacketHits& best_;
    float farthest_;            // greatest t of the best hits
    bool best_changed_ = false; // whether a best hit changed since `farthest_` was computed
    std::size_t size_ = 0;
    // A step down pushes at most kWidth children.
    std::array<PacketStackEntry, BvhNode::kWidth * Bvh::kMaxDepth + 1> stack_;
};

} // namespace duet::raytrace

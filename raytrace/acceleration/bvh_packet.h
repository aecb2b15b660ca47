// Sending a packet of coherent rays through a hierarchy together: each box and each triangle is fetched once and tested
// against all of them. The hits are those of `find_closest`, to the bit.
#pragma once

#include "raytrace/acceleration/bvh_traverse.h"

#include <span>

namespace duet::raytrace {

/// As many rays as the widest batch has lanes, made ready for tests: those of neighbouring pixels, say.
class RayPacket {
public:
    static constexpr std::size_t kSize = kMaxSimdLanes;
    using Batch = FloatBatch<kSize>;
    using Values = std::array<float, kSize>;

    RayPacket(std::span<const Ray, kSize> rays, const Box3& bounds) {
        alignas(64) std::array<Values, 8> lanes; // of the origin and the direction three each, t_min, t_max
        std::array<const float*, kSize> rows;
        for (std::size_t i = 0; i < kSize; ++i) rows[i] = reinterpret_cast<const float*>(&rays[i]);
        transpose_rows(rows, lanes);
        const auto load = [&](std::size_t k) { return Batch::load_aligned(lanes[k].data()); };
        const Vec3T<Batch> origin(load(0), load(1), load(2)), direction(load(3), load(4), load(5));
        t_min_ = load(6);
        t_max_ = load(7);
        coherent_ = set_axes(rays, origin, direction);
        if (!coherent_) return;
        shear_ = sheared(origin, direction);
        set_slabs(origin, direction, bounds);
    }

    /// Whether all rays run into the same octant along the same main axis, and can be traced. Nothing else may be asked
    /// of others.
    bool coherent() const { return coherent_; }
    Batch t_min() const { return t_min_; }
    Batch t_max() const { return t_max_; }
    const Shear<Batch>& shear() const { return shear_; }

    /// A bit for each child of the node whose box some of the rays may enter before `end`, the last of their ends; and
    /// for each a distance before which none does.
    SlabRay::Entered enter_any(const BvhNode& node, float end) const {
        using Boxes = SlabRay::Batch;
        const auto bound = [&](std::size_t axis, bool far) {
            const Interval& interval = far ? far_interval_[axis] : near_interval_[axis];
            const Boxes offset = Boxes::load_aligned(node.planes[axis + 3 * (far ^ backwards_[axis])].data()) - Boxes(interval.origin);
            const Boxes a = offset * Boxes(interval.low), b = offset * Boxes(interval.high);
            return far ? xsimd::max(a, b) : xsimd::min(a, b);
        };
        const Boxes near = xsimd::max(xsimd::max(bound(0, false), bound(1, false)), xsimd::max(bound(2, false), Boxes(first_)));
        const Boxes far = xsimd::min(xsimd::min(bound(0, true), bound(1, true)), xsimd::min(bound(2, true), Boxes(end)));
        return {near, lane_bits(near <= far)};
    }

    /// Where each ray enters the child's box; infinity where it does not by its end.
    Batch enter(const BvhNode& node, std::size_t child, Batch ends) const {
        const auto slab = [&](std::size_t axis, bool far) {
            const Batch plane(node.planes[axis + 3 * (far ^ backwards_[axis])][child]);
            return fused(plane, scale_[axis], far ? far_offset_[axis] : near_offset_[axis]);
        };
        const Batch near = xsimd::max(xsimd::max(slab(0, false), slab(1, false)), xsimd::max(slab(2, false), t_min_));
        const Batch far = xsimd::min(xsimd::min(slab(0, true), slab(1, true)), xsimd::min(slab(2, true), ends));
        return xsimd::select(near <= far, near, Batch(kInfinity));
    }

    /// One ray's part of the shear.
    Shear<float> shear(std::size_t lane) const {
        return {shear_.kx, shear_.ky, shear_.kz, {lanes_[0][lane], lanes_[1][lane], lanes_[2][lane]},
                lanes_[3][lane], lanes_[4][lane], lanes_[5][lane], lanes_[6][lane]};
    }

private:
    static_assert(offsetof(Ray, origin) == 0 && offsetof(Ray, direction) == 3 * sizeof(float) &&
                  offsetof(Ray, t_min) == 6 * sizeof(float) && offsetof(Ray, t_max) == 7 * sizeof(float));
    // A range of reciprocals of directions, and the end of the range of origins that makes the bound hold.
    struct Interval {
        float low, high, origin;
    };

    bool set_axes(std::span<const Ray, kSize> rays, const Vec3T<Batch>& origin, const Vec3T<Batch>& direction) {
        const Batch largest(kLargestNumber), zero(0.0f);
        constexpr unsigned kAll = (1u << kSize) - 1;
        if (lane_bits((t_min_ == t_min_) & (t_max_ == t_max_)) != kAll) return false; // some are NaN
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto in_range = (xsimd::abs(origin[axis]) <= largest) & (xsimd::abs(direction[axis]) <= largest);
            const unsigned negative = lane_bits(direction[axis] < zero);
            if (lane_bits(in_range) != kAll || (negative != 0 && negative != kAll)) return false;
            backwards_[axis] = negative != 0;
        }
        const Vec3T<Batch> size(xsimd::abs(direction.x), xsimd::abs(direction.y), xsimd::abs(direction.z));
        const unsigned x = lane_bits((size.x >= size.y) & (size.x >= size.z)), y = lane_bits(size.y >= size.z) & ~x;
        const std::size_t z_axis = longest_axis(abs(rays[0].direction));
        if ((z_axis == 0 ? x : z_axis == 1 ? y : kAll & ~x & ~y) != kAll) return false;
        shear_.kz = z_axis;
        return lane_bits(size[z_axis] >= Batch(1 / kLargestNumber)) == kAll;
    }

    // What ShearedRay computes for one.
    Shear<Batch> sheared(const Vec3T<Batch>& origin, const Vec3T<Batch>& direction) {
        const std::size_t kz = shear_.kz, next = (kz + 1) % 3, after = (kz + 2) % 3;
        const std::size_t kx = backwards_[kz] ? after : next, ky = backwards_[kz] ? next : after;
        const Shear<Batch> shear{kx, ky, kz, {origin[kx], origin[ky], origin[kz]},
                                 direction[kx] / direction[kz], direction[ky] / direction[kz], Batch(1.0f) / direction[kz],
                                 xsimd::abs(direction[kz])};
        const Batch values[] = {shear.origin.x, shear.origin.y, shear.origin.z, shear.sx,
                                shear.sy,       shear.sz,       shear.speed};
        for (std::size_t k = 0; k < std::size(values); ++k) values[k].store_aligned(lanes_[k].data());
        return shear;
    }

    // As SlabRay does for one.
    void set_slabs(const Vec3T<Batch>& origin, const Vec3T<Batch>& direction, const Box3& bounds) {
        const Batch relative(SlabRay::relative_error());
        std::array<Batch, 3> extent;
        for (std::size_t axis = 0; axis < 3; ++axis)
            extent[axis] = xsimd::max(xsimd::abs(Batch(bounds.low[axis]) - origin[axis]), xsimd::abs(Batch(bounds.high[axis]) - origin[axis]));
        const Batch largest = xsimd::max(xsimd::max(extent[0], extent[1]), extent[2]);
        const Batch smallest = Batch(SlabRay::kSmallest) * xsimd::abs(direction[shear_.kz]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Batch error = (extent[axis] + extent[axis] + largest + xsimd::abs(origin[axis])) * relative +
                                Batch(std::numeric_limits<float>::min());
            const Batch sign(backwards_[axis] ? -1.0f : 1.0f);
            const Batch away = error * sign;
            const Batch least = SlabRay::least_divisor(extent[axis] + xsimd::abs(origin[axis]));
            const Batch reciprocal = sign / xsimd::max(xsimd::max(xsimd::abs(direction[axis]), smallest), least);
            const Batch near_origin = origin[axis] + away, far_origin = origin[axis] - away;
            scale_[axis] = reciprocal;
            near_offset_[axis] = -near_origin * reciprocal;
            far_offset_[axis] = -far_origin * reciprocal;
            const float low = lowest(reciprocal), high = highest(reciprocal);
            near_interval_[axis] = {low, high, backwards_[axis] ? lowest(near_origin) : highest(near_origin)};
            far_interval_[axis] = {low, high, backwards_[axis] ? highest(far_origin) : lowest(far_origin)};
        }
        first_ = lowest(t_min_);
    }

    bool coherent_;
    std::array<bool, 3> backwards_;
    Shear<Batch> shear_;
    alignas(64) std::array<Values, 7> lanes_; // the shear's, to be picked from
    Batch t_min_, t_max_;
    float first_;
    std::array<Batch, 3> scale_, near_offset_, far_offset_;
    std::array<Interval, 3> near_interval_, far_interval_;
};

/// The closest hits of a coherent packet's rays, as `find_closest` finds them for each. `instance(ray)` makes what
/// `find_closest` asks for instances' hits.
template <typename Instance> class PacketTraversal {
public:
    static constexpr std::size_t kSize = RayPacket::kSize;

    PacketTraversal(const Bvh& bvh, const RayPacket& packet, std::span<const Ray, kSize> rays, const Instance& instance)
        : bvh_(bvh), packet_(packet), rays_(rays), instance_(instance) {
        object_.fill(kNoObject);
        set_ends(xsimd::min(packet.t_max(), Batch(std::numeric_limits<float>::max()))); // what overflowed is no distance
    }

    void run(std::span<Hit, kSize> hits) {
        if (bvh_.nodes.empty())
            for (const BvhRef leaf : bvh_.list) test_leaf(leaf, kAll);
        else
            traverse();
        for (std::size_t ray = 0; ray < kSize; ++ray) hits[ray] = object_[ray] == kNoObject ? Hit{} : best(ray);
    }

private:
    using Batch = RayPacket::Batch;
    static constexpr unsigned kAll = (1u << kSize) - 1;
    // Up to so many rays are tested one by one against a whole block of polygons, more with each polygon at a time.
    static constexpr int kFewRays = kSize / 2;

    // A child that waits, and where each ray enters its box.
    struct Waiting {
        alignas(sizeof(Batch)) RayPacket::Values entry;
        float nearest;
        BvhRef child;
    };

    void traverse() {
        BvhRef next = BvhRef::node(0);
        unsigned active = kAll;
        for (;;) {
            while (active != 0 && !next.is_leaf()) active = step(next);
            if (active != 0) test_leaf(next, active);
            do {
                if (size_ == 0) return;
                --size_;
                active = lane_bits(Batch::load_aligned(stack_[size_].entry.data()) <= ends());
            } while (active == 0);
            next = stack_[size_].child;
        }
    }

    // From a node to its nearest child that some rays enter, the others waiting; returns those rays, 0 where there is
    // none.
    unsigned step(BvhRef& next) {
        const BvhNode& node = node_at(bvh_, next);
        const auto [distance, entered] = packet_.enter_any(node, last_);
        if (entered == 0) return 0;
        for (unsigned children = entered; children != 0; children &= children - 1)
            prefetch(bvh_, node.children[static_cast<std::size_t>(std::countr_zero(children))]);
        const Lanes nearest(distance);
        const std::size_t bottom = size_;
        for (unsigned children = entered; children != 0; children &= children - 1) {
            const auto child = static_cast<std::size_t>(std::countr_zero(children));
            const Batch entry = packet_.enter(node, child, ends());
            if (lane_bits(entry < Batch(kInfinity)) == 0) continue;
            std::size_t i = size_++;
            for (; i > bottom && stack_[i - 1].nearest < nearest[child]; --i) stack_[i] = stack_[i - 1];
            entry.store_aligned(stack_[i].entry.data());
            stack_[i].nearest = nearest[child];
            stack_[i].child = node.children[child];
        }
        if (size_ == bottom) return 0;
        --size_;
        next = stack_[size_].child;
        return lane_bits(Batch::load_aligned(stack_[size_].entry.data()) < Batch(kInfinity));
    }

    void test_leaf(BvhRef leaf, unsigned active) {
        if (leaf.kind() == PrimitiveKind::kTriangle) {
            test(bvh_.triangles[leaf.index()], active);
        } else if (leaf.kind() == PrimitiveKind::kQuad) {
            test(bvh_.quads[leaf.index()], active);
        } else {
            for (; active != 0; active &= active - 1) {
                const auto ray = static_cast<std::size_t>(std::countr_zero(active));
                const auto instance = instance_(rays_[ray]);
                Hit hit = best(ray);
                LeafTest<false, decltype(instance)>(bvh_, rays_[ray], kNoObject, instance)(leaf, hit);
                set_best(ray, hit);
            }
        }
        last_ = highest(ends());
    }

    template <std::size_t kCorners> void test(const PolygonBlock<kCorners>& block, unsigned active) {
        if (std::popcount(active) <= kFewRays)
            ray_by_ray(block, active);
        else
            one_by_one(block, active);
    }

    template <std::size_t kCorners> void ray_by_ray(const PolygonBlock<kCorners>& block, unsigned active) {
        for (; active != 0; active &= active - 1) {
            const auto ray = static_cast<std::size_t>(std::countr_zero(active));
            const BlockTest<kCorners> test(packet_.shear(ray), block, t_[ray]);
            if (test.candidates() == 0) continue;
            const Lanes t(test.t()), u(test.u()), v(test.v());
            for (unsigned lanes = test.candidates(); lanes != 0; lanes &= lanes - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
                if (!(test.certain() >> lane & 1))
                    consider_exactly(block, lane, ray);
                else if (t[lane] > rays_[ray].t_min && t[lane] <= t_[ray])
                    consider(block, lane, ray, {t[lane], u[lane], v[lane]});
            }
        }
    }

    template <std::size_t kCorners> void one_by_one(const PolygonBlock<kCorners>& block, unsigned active) {
        for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
            const std::array<Vec3, kCorners> corners = block.corners(lane);
            if (corners[0].x != corners[0].x) return; // absent, and so are the rest
            const CandidateTest<Batch> test(packet_.shear(), corners, ends());
            const unsigned candidates = test.candidates() & active;
            if (candidates == 0) continue;
            const unsigned nearer = lane_bits((test.t() > packet_.t_min()) & (test.t() < ends()));
            const unsigned ties = lane_bits((test.t() > packet_.t_min()) & (test.t() == ends()));
            const unsigned certain = test.certain() & candidates;
            if ((certain & nearer) != 0) take(certain & nearer, test, block.object[lane], block.primitive[lane]);
            if ((certain & ties) != 0) consider_each(certain & ties, block, lane, test);
            for (unsigned rays = candidates & ~certain; rays != 0; rays &= rays - 1)
                consider_exactly(block, lane, static_cast<std::size_t>(std::countr_zero(rays)));
        }
    }

    // The hits become these rays' best ones.
    void take(unsigned rays, const CandidateTest<Batch>& test, std::uint32_t object, std::uint32_t primitive) {
        store_lanes(test.t(), rays, t_.data());
        store_lanes(test.u(), rays, u_.data());
        store_lanes(test.v(), rays, v_.data());
        store_lanes(object, rays, object_);
        store_lanes(primitive, rays, primitive_);
    }
    template <typename Block>
    void consider_each(unsigned rays, const Block& block, std::size_t lane, const CandidateTest<Batch>& test) {
        const Lanes t(test.t()), u(test.u()), v(test.v());
        for (; rays != 0; rays &= rays - 1) {
            const auto ray = static_cast<std::size_t>(std::countr_zero(rays));
            consider(block, lane, ray, {t[ray], u[ray], v[ray]});
        }
    }
    template <typename Block> void consider_exactly(const Block& block, std::size_t lane, std::size_t ray) {
        Ray ended = rays_[ray];
        ended.t_max = t_[ray];
        if (const auto hit = exact_hit(ShearedRay(ended), block, lane)) consider(block, lane, ray, *hit);
    }
    template <typename Block>
    void consider(const Block& block, std::size_t lane, std::size_t ray, const TriangleHit& hit) {
        const Hit found{block.object[lane], block.primitive[lane], hit.u, hit.v, hit.t};
        if (precedes(found, best(ray))) set_best(ray, found);
    }

    Hit best(std::size_t ray) const { return {object_[ray], primitive_[ray], u_[ray], v_[ray], t_[ray]}; }
    void set_best(std::size_t ray, const Hit& hit) {
        object_[ray] = hit.object;
        primitive_[ray] = hit.primitive;
        u_[ray] = hit.u;
        v_[ray] = hit.v;
        t_[ray] = hit.t;
    }
    Batch ends() const { return Batch::load_aligned(t_.data()); }
    void set_ends(Batch t) {
        t.store_aligned(t_.data());
        last_ = highest(t);
    }

    const Bvh& bvh_;
    const RayPacket& packet_;
    std::span<const Ray, kSize> rays_;
    const Instance& instance_;
    alignas(sizeof(Batch)) RayPacket::Values t_, u_, v_; // of the best hits so far; t: of the rays' ends, where there is none
    alignas(sizeof(Batch)) std::array<std::uint32_t, kSize> object_, primitive_;
    float last_; // the greatest t
    std::size_t size_ = 0;
    // Each step down leaves at most kWidth children waiting.
    std::array<Waiting, BvhNode::kWidth * Bvh::kMaxDepth + 1> stack_;
};

} // namespace duet::raytrace

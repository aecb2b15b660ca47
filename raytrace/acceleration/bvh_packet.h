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

    /// Of rays for a tree over those bounds.
    RayPacket(std::span<const Ray, kSize> rays, const Box3& bounds) : RayPacket(rays, &bounds) {}
    /// For a list of primitives: nothing that only boxes are asked for.
    explicit RayPacket(std::span<const Ray, kSize> rays) : RayPacket(rays, nullptr) {}

    /// Whether all rays run into the same octant (for a list: the same way) along the same main axis, and can be traced.
    /// Nothing else may be asked of others.
    bool coherent() const { return coherent_; }
    Batch t_min() const { return t_min_; }
    Batch t_max() const { return t_max_; }
    const Shear<Batch>& shear() const { return shear_; }
    const LineLanes<kSize>& lines() const { return lines_; }

    /// A bit for each child of the node whose box some of the rays may enter before `end`, the last of their ends; and
    /// for each a distance before which none does.
    SlabRay::Entered enter_any(const BvhNode& node, float end) const {
        using Boxes = SlabRay::Batch;
        const auto bound = [&](const Interval& interval, std::size_t plane, bool far) {
            const Boxes offset = Boxes::load_aligned(plane_of(node, plane)) - Boxes(interval.origin);
            const Boxes a = offset * Boxes(interval.low), b = offset * Boxes(interval.high);
            return far ? xsimd::max(a, b) : xsimd::min(a, b);
        };
        const auto near_bound = [&](std::size_t axis) { return bound(near_interval_[axis], near_plane_[axis], false); };
        const auto far_bound = [&](std::size_t axis) { return bound(far_interval_[axis], far_plane_[axis], true); };
        const Boxes near =
            xsimd::max(xsimd::max(near_bound(0), near_bound(1)), xsimd::max(near_bound(2), Boxes(first_)));
        const Boxes far = xsimd::min(xsimd::min(far_bound(0), far_bound(1)), xsimd::min(far_bound(2), Boxes(end)));
        return {near, lane_bits(near <= far)};
    }

    /// Where each ray enters the child's box, and a bit for each ray that does so by its end.
    struct Entering {
        Batch distance;
        Batch::batch_bool_type enters;
    };
    Entering enter(const BvhNode& node, std::size_t child, Batch ends) const {
        const auto slab = [&](std::size_t plane, std::size_t axis, Batch offset) {
            return fused(Batch(plane_of(node, plane)[child]), scale_[axis], offset);
        };
        const auto near_slab = [&](std::size_t axis) { return slab(near_plane_[axis], axis, near_offset_[axis]); };
        const auto far_slab = [&](std::size_t axis) { return slab(far_plane_[axis], axis, far_offset_[axis]); };
        const Batch near = xsimd::max(xsimd::max(near_slab(0), near_slab(1)), xsimd::max(near_slab(2), t_min_));
        const Batch far = xsimd::min(xsimd::min(far_slab(0), far_slab(1)), xsimd::min(far_slab(2), ends));
        return {near, near <= far};
    }

    /// The origin that all rays have in common, if they do.
    const std::optional<Vec3>& origin() const { return origin_; }
    /// What some of the rays' shears are, each for its share of the lanes.
    template <std::size_t N> Shear<Batch> shears(const std::array<std::size_t, N>& rays) const {
        const auto pick = [&](std::size_t k) { return share(lanes_[k], rays); };
        return {shear_.kx, shear_.ky, shear_.kz, {pick(0), pick(1), pick(2)}, pick(3), pick(4), pick(5), pick(6)};
    }
    static Batch share(const Values& values, const std::array<std::size_t, 1>& rays) { return Batch(values[rays[0]]); }
    static Batch share(const Values& values, const std::array<std::size_t, 2>& rays) {
        return halves<kSize>(values[rays[0]], values[rays[1]]);
    }

private:
    RayPacket(std::span<const Ray, kSize> rays, const Box3* bounds) {
        const auto columns = [&](std::size_t first) {
            return load_columns<kSize>([&](std::size_t i) { return reinterpret_cast<const float*>(&rays[i]) + first; });
        };
        const auto [ox, oy, oz, dx] = columns(0);
        const auto [dy, dz, t_min, t_max] = columns(4);
        const Vec3T<Batch> origin(ox, oy, oz), direction(dx, dy, dz);
        t_min_ = t_min;
        t_max_ = t_max;
        coherent_ = set_axes(rays, origin, direction, bounds != nullptr);
        if (!coherent_) return;
        shear_ = sheared(origin, direction);
        const std::array<Batch, 6> columns_of_lines{ox, oy, oz, dx, dy, dz};
        for (std::size_t k = 0; k < columns_of_lines.size(); ++k) columns_of_lines[k].store_aligned(lines_[k].data());
        const Vec3 first = rays[0].origin;
        const auto same = (ox == Batch(first.x)) & (oy == Batch(first.y)) & (oz == Batch(first.z));
        if (lane_bits(same) == kAllRays) origin_ = first;
        if (bounds != nullptr) set_slabs(origin, direction, *bounds);
    }

    static_assert(offsetof(Ray, origin) == 0 && offsetof(Ray, direction) == 3 * sizeof(float) &&
                  offsetof(Ray, t_min) == 6 * sizeof(float) && offsetof(Ray, t_max) == 7 * sizeof(float));
    // A range of reciprocals of directions, and the end of the range of origins that makes the bound hold.
    struct Interval {
        float low, high, origin;
    };

    bool set_axes(std::span<const Ray, kSize> rays, const Vec3T<Batch>& origin, const Vec3T<Batch>& direction,
                  bool one_octant) {
        const std::size_t z_axis = longest_axis(abs(rays[0].direction));
        const Batch largest(kLargestNumber), zero(0.0f);
        constexpr unsigned kAll = kAllRays;
        if (lane_bits((t_min_ == t_min_) & (t_max_ == t_max_)) != kAll) return false; // some are NaN
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto in_range = (xsimd::abs(origin[axis]) <= largest) & (xsimd::abs(direction[axis]) <= largest);
            const unsigned negative = lane_bits(direction[axis] < zero);
            const bool mixed = negative != 0 && negative != kAll;
            if (lane_bits(in_range) != kAll || (mixed && (one_octant || axis == z_axis))) return false;
            backwards_[axis] = negative != 0;
            near_plane_[axis] = sizeof(BvhNode::Lanes) * (axis + 3 * backwards_[axis]);
            far_plane_[axis] = sizeof(BvhNode::Lanes) * (axis + 3 * !backwards_[axis]);
        }
        const Vec3T<Batch> size(xsimd::abs(direction.x), xsimd::abs(direction.y), xsimd::abs(direction.z));
        const unsigned x = lane_bits((size.x >= size.y) & (size.x >= size.z)), y = lane_bits(size.y >= size.z) & ~x;
        if ((z_axis == 0 ? x : z_axis == 1 ? y : kAll & ~x & ~y) != kAll) return false;
        shear_.kz = z_axis;
        return lane_bits(size[z_axis] >= Batch(1 / kLargestNumber)) == kAll;
    }

    // What ShearedRay computes for one.
    Shear<Batch> sheared(const Vec3T<Batch>& origin, const Vec3T<Batch>& direction) {
        const std::size_t kz = shear_.kz, next = (kz + 1) % 3, after = (kz + 2) % 3;
        const std::size_t kx = backwards_[kz] ? after : next, ky = backwards_[kz] ? next : after;
        const Shear<Batch> shear{kx,
                                 ky,
                                 kz,
                                 {origin[kx], origin[ky], origin[kz]},
                                 direction[kx] / direction[kz],
                                 direction[ky] / direction[kz],
                                 Batch(1.0f) / direction[kz],
                                 xsimd::abs(direction[kz])};
        const Batch values[] = {shear.origin.x, shear.origin.y, shear.origin.z, shear.sx,
                                shear.sy,       shear.sz,       shear.speed};
        for (std::size_t k = 0; k < std::size(values); ++k) values[k].store_aligned(lanes_[k].data());
        return shear;
    }

    // As SlabRay does for one, with the widest error of all origins.
    void set_slabs(const Vec3T<Batch>& origin, const Vec3T<Batch>& direction, const Box3& bounds) {
        const Box3 origins = origin_ ? Box3{*origin_, *origin_} : extent_of(origin);
        const Vec3 extents = max(abs(bounds.low - origins.high), abs(bounds.high - origins.low)),
                   sizes = max(abs(origins.low), abs(origins.high));
        const float largest = max_component(extents);
        Vec3 ahead, behind;
        const Batch smallest = Batch(SlabError::kSmallest) * xsimd::abs(direction[shear_.kz]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float error = (2 * extents[axis] + largest + sizes[axis]) * SlabError::relative() +
                                std::numeric_limits<float>::min();
            const float sign = backwards_[axis] ? -1.0f : 1.0f, away = error * sign;
            const Batch least(SlabError::least_divisor(extents[axis] + sizes[axis]));
            scale_[axis] = Batch(sign) / xsimd::max(xsimd::max(xsimd::abs(direction[axis]), smallest), least);
            near_offset_[axis] = -(origin[axis] + Batch(away)) * scale_[axis];
            far_offset_[axis] = -(origin[axis] - Batch(away)) * scale_[axis];
            ahead[axis] = (backwards_[axis] ? origins.low[axis] : origins.high[axis]) + away;
            behind[axis] = (backwards_[axis] ? origins.high[axis] : origins.low[axis]) - away;
        }
        const Lanes low(lowest_of_each(std::array{scale_[0], scale_[1], scale_[2], t_min_})),
            minus_high(lowest_of_each(std::array{-scale_[0], -scale_[1], -scale_[2], t_min_}));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            near_interval_[axis] = {low[axis], -minus_high[axis], ahead[axis]};
            far_interval_[axis] = {low[axis], -minus_high[axis], behind[axis]};
        }
        first_ = low[3];
    }
    static Box3 extent_of(const Vec3T<Batch>& points) {
        return {{lowest(points.x), lowest(points.y), lowest(points.z)},
                {highest(points.x), highest(points.y), highest(points.z)}};
    }
    static const float* plane_of(const BvhNode& node, std::size_t plane) {
        return reinterpret_cast<const float*>(reinterpret_cast<const char*>(&node) + plane);
    }

    static constexpr unsigned kAllRays = (1u << kSize) - 1;

    bool coherent_;
    std::array<bool, 3> backwards_;
    std::array<std::size_t, 3> near_plane_, far_plane_; // in bytes from the node
    std::optional<Vec3> origin_;
    Shear<Batch> shear_;
    alignas(64) std::array<Values, 7> lanes_; // the shear's, to be picked from
    alignas(64) LineLanes<kSize> lines_;
    Batch t_min_, t_max_;
    float first_;
    std::array<Batch, 3> scale_, near_offset_, far_offset_;
    std::array<Interval, 3> near_interval_, far_interval_;
};

/// The corners of a block's polygons, or their differences from the origin that all rays have in common: then each is
/// computed once for all of them.
template <std::size_t kCorners, bool kRelative> class BlockCorners {
public:
    using Batch = RayPacket::Batch;
    using Axes = std::array<BlockLanes<float>, 3>;

    explicit BlockCorners(const std::array<Axes, kCorners>& corners) : corners_(corners) {}

    /// The polygon of one lane, for all rays.
    auto of(std::size_t lane) const {
        return each(std::make_index_sequence<kCorners>(), [&](const Axes& axes) { return Single{&axes, lane}; });
    }
    /// All polygons, for rays that each have a share of the lanes as wide as the block.
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
            return std::array{Relative{make(corners_[i])}...};
        else
            return std::array{make(corners_[i])...};
    }

    const std::array<Axes, kCorners>& corners_;
};

/// The nearest hits of a packet's rays so far; t is the ray's end where there is none.
struct PacketHits {
    static constexpr std::size_t kSize = RayPacket::kSize;
    template <typename T> using PerRay = std::array<T, kSize>;

    alignas(64) PerRay<float> t, u, v;
    alignas(64) PerRay<std::uint32_t> object, primitive;

    /// None yet.
    explicit PacketHits(RayPacket::Batch ends) {
        ends.store_aligned(t.data());
        u.fill(0);
        v.fill(0);
        object.fill(kNoObject);
        primitive.fill(0);
    }

    Hit get(std::size_t ray) const { return {object[ray], primitive[ray], u[ray], v[ray], t[ray]}; }
    void set(std::size_t ray, const Hit& hit) {
        object[ray] = hit.object;
        primitive[ray] = hit.primitive;
        u[ray] = hit.u;
        v[ray] = hit.v;
        t[ray] = hit.t;
    }
    void store(std::span<Hit, kSize> hits) const {
        static_assert(offsetof(Hit, object) == 0 && offsetof(Hit, primitive) == 4 && offsetof(Hit, u) == 8 &&
                      offsetof(Hit, v) == 12);
        const auto bits = [](const auto& values) {
            return RayPacket::Batch::load_aligned(reinterpret_cast<const float*>(values.data()));
        };
        store_columns<kSize>(std::array{bits(object), bits(primitive), bits(u), bits(v)},
                             [&](std::size_t ray) { return reinterpret_cast<float*>(&hits[ray]); });
        for (std::size_t ray = 0; ray < kSize; ++ray) hits[ray].t = object[ray] == kNoObject ? kInfinity : t[ray];
    }
};

/// What a hierarchy without instances asks of them.
struct NoInstances {
    auto operator()(const Ray&) const {
        return [](const BvhInstance&, Hit&) { return false; };
    }
    void operator()(const BvhInstance&, unsigned, PacketHits&) const {}
};

/// Finds for a coherent packet's rays what `find_closest` finds for each.
template <typename Instances> class PacketTraversal {
public:
    static constexpr std::size_t kSize = RayPacket::kSize;

    /// `active`: a bit for each ray that counts. object: of the primitives where it is not kNoObject (an instance's).
    /// instances(ray) makes what `find_closest` asks for one ray's hits of instances, instances(i, rays, best) finds
    /// those of several rays.
    PacketTraversal(const Bvh& bvh, const RayPacket& packet, std::span<const Ray, kSize> rays, unsigned active,
                    std::uint32_t object, const Instances& instances, PacketHits& best)
        : bvh_(bvh), packet_(packet), rays_(rays), active_(active), object_(object), instances_(instances), best_(best),
          last_(highest(ends())) {}

    void run() {
        if (bvh_.nodes.empty())
            run_list();
        else
            traverse();
    }
    /// Of a list, for a packet that was made for one.
    void run_list() {
        for (const BvhRef leaf : bvh_.list) test_leaf(leaf, active_);
    }

private:
    using Batch = RayPacket::Batch;
    // Up to so many rays are tested against a whole block of polygons, more with each polygon at a time.
    static constexpr int kFewRays = kSize / 2;
    // From so many on they are tested together against a sphere, fewer each against all of a block.
    static constexpr int kSomeRays = 3;
    // Rays that are tested together against a block, each in its share of the lanes.
    static constexpr std::size_t kShares = kSize / kBlockSize;

    // A child that waits, and where each ray enters its box.
    struct Waiting {
        alignas(sizeof(Batch)) RayPacket::Values entry; // infinity: not at all
        float nearest;
        unsigned entering; // a bit for each ray that enters
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
        } else if (leaf.kind() == PrimitiveKind::kInstance && std::popcount(active) > kFewRays) {
            instances_(bvh_.instances[leaf.index()], active, best_);
            nearer_ = true;
        } else if (leaf.kind() == PrimitiveKind::kSphere && std::popcount(active) >= kSomeRays &&
                   !sabotaged(Guard::kSphereRoots)) {
            test(bvh_.spheres[leaf.index()], active);
        } else {
            for (; active != 0; active &= active - 1) {
                const auto ray = static_cast<std::size_t>(std::countr_zero(active));
                const auto instance = instances_(rays_[ray]);
                Hit hit = best_.get(ray);
                LeafTest<false, decltype(instance)>(bvh_, rays_[ray], object_, instance)(leaf, hit);
                set_best(ray, hit);
            }
        }
        if (nearer_) last_ = highest(ends());
        nearer_ = false;
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
        if (std::popcount(active) <= kFewRays)
            ray_by_ray(block, corners, active);
        else
            one_by_one(block, corners, active);
    }

    // Some rays at a time, as many as blocks fill a batch, against all of the block.
    template <std::size_t kCorners, typename Corners>
    void ray_by_ray(const PolygonBlock<kCorners>& block, const Corners& corners, unsigned active) {
        const auto vertices = corners.of_all();
        while (active != 0) {
            std::array<std::size_t, kShares> rays;
            unsigned known = 0; // lanes of a ray that is there already, where too few are left
            for (std::size_t i = 0; i < kShares; ++i) {
                if (active == 0) known |= ((1u << kBlockSize) - 1) << (i * kBlockSize);
                rays[i] = active != 0 ? static_cast<std::size_t>(std::countr_zero(active)) : rays[0];
                active &= active - 1;
            }
            const CandidateTest<Batch> test(packet_.shears(rays), vertices, RayPacket::share(best_.t, rays));
            unsigned candidates = test.candidates() & ~known;
            if (candidates == 0) continue;
            const Lanes t(test.t()), u(test.u()), v(test.v());
            for (; candidates != 0; candidates &= candidates - 1) {
                const auto i = static_cast<std::size_t>(std::countr_zero(candidates));
                const std::size_t lane = i % kBlockSize, ray = rays[i / kBlockSize];
                if (!(test.certain() >> i & 1))
                    consider_exactly(block, lane, ray);
                else if (t[i] > rays_[ray].t_min && t[i] <= best_.t[ray])
                    consider(block, lane, ray, {t[i], u[i], v[i]});
            }
        }
    }

    // A polygon at a time against all rays.
    template <std::size_t kCorners, typename Corners>
    void one_by_one(const PolygonBlock<kCorners>& block, const Corners& corners, unsigned active) {
        for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
            const float x = block.corner[0][0][lane];
            if (x != x) return; // absent, and so are the rest
            const CandidateTest<Batch> test(packet_.shear(), corners.of(lane), ends());
            const unsigned candidates = test.candidates() & active;
            if (candidates == 0) continue;
            const unsigned nearer = lane_bits((test.t() > packet_.t_min()) & (test.t() < ends()));
            const unsigned ties = lane_bits((test.t() > packet_.t_min()) & (test.t() == ends()));
            const unsigned certain = test.certain() & candidates;
            if ((certain & nearer) != 0)
                take(certain & nearer, test.t(), test.u(), test.v(), block.object[lane], block.primitive[lane]);
            if ((certain & ties) != 0) consider_each(certain & ties, block, lane, test);
            const unsigned touched = test.touched();
            if ((touched & candidates) != 0) consider_touched(touched & candidates, block, lane, test);
            for (unsigned rays = candidates & ~certain & ~touched; rays != 0; rays &= rays - 1)
                consider_exactly(block, lane, static_cast<std::size_t>(std::countr_zero(rays)));
        }
    }

    // A sphere at a time: in double against the rays that do not surely miss it.
    [[gnu::noinline]] void test(const SphereBlock& block, unsigned active) {
        const SphereFilter filter(packet_.lines());
        for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
            const Sphere sphere = block.sphere(lane);
            if (sphere.radius != sphere.radius) return; // absent, and so are the rest
            const unsigned candidates = filter.may_meet(sphere) & active;
            if (candidates == 0) continue;
            const SphereRaysTest test(packet_.lines(), candidates, sphere, packet_.t_min(), ends());
            const unsigned nearer = test.hits() & lane_bits(test.t() < ends());
            const Batch zero(0.0f);
            const Lanes t(test.t());
            for (unsigned ties = test.hits() & ~nearer; ties != 0; ties &= ties - 1) {
                const auto ray = static_cast<std::size_t>(std::countr_zero(ties));
                consider(ray, {name(block.object[lane]), 0, 0, 0, t[ray]});
            }
            if (nearer != 0) take(nearer, test.t(), zero, zero, block.object[lane], 0);
        }
    }

    // The hits become these rays' best ones.
    void take(unsigned rays, Batch t, Batch u, Batch v, std::uint32_t object, std::uint32_t primitive) {
        nearer_ = true;
        store_lanes(t, rays, best_.t.data());
        store_lanes(u, rays, best_.u.data());
        store_lanes(v, rays, best_.v.data());
        store_lanes(name(object), rays, best_.object);
        store_lanes(primitive, rays, best_.primitive);
    }
    template <typename Block>
    void consider_each(unsigned rays, const Block& block, std::size_t lane, const CandidateTest<Batch>& test) {
        const Lanes t(test.t()), u(test.u()), v(test.v());
        for (; rays != 0; rays &= rays - 1) {
            const auto ray = static_cast<std::size_t>(std::countr_zero(rays));
            consider(block, lane, ray, {t[ray], u[ray], v[ray]});
        }
    }
    // The rays that may be leaving a polygon: what is left to find is how far it is.
    template <std::size_t kCorners>
    [[gnu::noinline]] void consider_touched(unsigned rays, const PolygonBlock<kCorners>& block, std::size_t lane,
                                            const CandidateTest<Batch>& test) {
        const Lanes u(test.u()), v(test.v());
        const unsigned first_half = kCorners == 3 ? ~0u : lane_bits(test.first_half());
        const auto corners = block.corners(lane);
        for (; rays != 0; rays &= rays - 1) {
            const auto ray = static_cast<std::size_t>(std::countr_zero(rays));
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
        consider(ray, {name(block.object[lane]), block.primitive[lane], hit.u, hit.v, hit.t});
    }
    void consider(std::size_t ray, const Hit& found) {
        if (precedes(found, best_.get(ray))) set_best(ray, found);
    }

    void set_best(std::size_t ray, const Hit& hit) {
        best_.set(ray, hit);
        nearer_ = true;
    }
    Batch ends() const { return Batch::load_aligned(best_.t.data()); }
    std::uint32_t name(std::uint32_t own) const { return object_ == kNoObject ? own : object_; }

    const Bvh& bvh_;
    const RayPacket& packet_;
    std::span<const Ray, kSize> rays_;
    unsigned active_;
    std::uint32_t object_;
    const Instances& instances_;
    PacketHits& best_;
    float last_;          // the greatest t
    bool nearer_ = false; // whether one has got less since
    std::size_t size_ = 0;
    // Each step down leaves at most kWidth children waiting.
    std::array<Waiting, BvhNode::kWidth * Bvh::kMaxDepth + 1> stack_;
};

} // namespace duet::raytrace

// Declares packets of coherent rays, which are tested together against boxes, triangles and spheres, and their hits.
#pragma once

#include "raytrace/acceleration/bvh_traverse.h"

#include <span>

namespace duet::raytrace {

/// Prepares coherent rays, such as those of neighboring pixels, for SIMD tests. A packet has as many rays as the widest
/// batch has lanes.
class RayPacket {
public:
    static constexpr std::size_t kSize = kMaxSimdLanes;
    using Batch = FloatBatch<kSize>;
    using Values = std::array<float, kSize>;

    /// Prepares rays for a tree with these bounds.
    RayPacket(std::span<const Ray, kSize> rays, const Box3& bounds) : RayPacket(rays, &bounds) {}
    /// Prepares rays for a list of primitives, without the values that only box tests need.
    explicit RayPacket(std::span<const Ray, kSize> rays) : RayPacket(rays, nullptr) {}

    /// Returns whether all rays can be traced, have the same dominant axis, and have directions in the same octant
    /// (for a list: the same sign along that axis). A packet that is not coherent must not be tested against
    /// anything.
    bool coherent() const { return coherent_; }
    Batch t_min() const { return t_min_; }
    Batch t_max() const { return t_max_; }
    const Shear<Batch>& shear() const { return shear_; }
    const LineLanes<kSize>& lines() const { return lines_; }

    /// Returns a bit mask of the node's children whose box some ray may enter before `end`, which is the greatest end
    /// of the rays. For each child it also returns a lower bound of the distance at which they enter.
    SlabRay::Entered enter_any(const BvhNode& node, float end) const {
        using Boxes = SlabRay::Batch;
        const auto bound = [&](const Interval& interval, std::size_t plane, bool far) {
            const Boxes offset = Boxes::load_aligned(node.plane(plane)) - Boxes(interval.origin);
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

    /// Holds the distance at which each ray enters a child's box, and a mask of the rays that enter it before their
    /// end.
    struct Entering {
        Batch distance;
        Batch::batch_bool_type enters;
    };
    Entering enter(const BvhNode& node, std::size_t child, Batch ends) const {
        const auto slab = [&](std::size_t plane, std::size_t axis, Batch offset) {
            return multiply_add(Batch(node.plane(plane)[child]), scale_[axis], offset);
        };
        const auto near_slab = [&](std::size_t axis) { return slab(near_plane_[axis], axis, near_offset_[axis]); };
        const auto far_slab = [&](std::size_t axis) { return slab(far_plane_[axis], axis, far_offset_[axis]); };
        const Batch near = xsimd::max(xsimd::max(near_slab(0), near_slab(1)), xsimd::max(near_slab(2), t_min_));
        const Batch far = xsimd::min(xsimd::min(far_slab(0), far_slab(1)), xsimd::min(far_slab(2), ends));
        return {near, near <= far};
    }

    /// Returns the common origin of all rays, if they have one.
    const std::optional<Vec3>& origin() const { return origin_; }
    /// Returns the shears of some rays, each repeated in an equal number of lanes.
    template <std::size_t N> Shear<Batch> shears(const std::array<std::size_t, N>& rays) const {
        const auto pick = [&](std::size_t k) { return lanes_of(lanes_[k], rays); };
        return {shear_.kx, shear_.ky, shear_.kz, {pick(0), pick(1), pick(2)}, pick(3), pick(4), pick(5), pick(6)};
    }
    static Batch lanes_of(const Values& values, const std::array<std::size_t, 1>& rays) {
        return Batch(values[rays[0]]);
    }
    static Batch lanes_of(const Values& values, const std::array<std::size_t, 2>& rays) {
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
    // Holds the range of the reciprocal directions, and the end of the range of origins that makes the bound
    // conservative.
    struct Interval {
        float low, high, origin;
    };

    bool set_axes(std::span<const Ray, kSize> rays, const Vec3T<Batch>& origin, const Vec3T<Batch>& direction,
                  bool one_octant) {
        const std::size_t z_axis = longest_axis(abs(rays[0].direction));
        const Batch largest(kLargestNumber), zero(0.0f);
        constexpr unsigned kAll = kAllRays;
        if (lane_bits((t_min_ == t_min_) & (t_max_ == t_max_)) != kAll) return false; // some distances are NaN
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto in_range = (xsimd::abs(origin[axis]) <= largest) & (xsimd::abs(direction[axis]) <= largest);
            const unsigned negative = lane_bits(direction[axis] < zero);
            const bool mixed = negative != 0 && negative != kAll;
            if (lane_bits(in_range) != kAll || (mixed && (one_octant || axis == z_axis))) return false;
            negative_[axis] = negative != 0;
            near_plane_[axis] = sizeof(BvhNode::Lanes) * (axis + 3 * negative_[axis]);
            far_plane_[axis] = sizeof(BvhNode::Lanes) * (axis + 3 * !negative_[axis]);
        }
        const Vec3T<Batch> size(xsimd::abs(direction.x), xsimd::abs(direction.y), xsimd::abs(direction.z));
        const unsigned x = lane_bits((size.x >= size.y) & (size.x >= size.z)), y = lane_bits(size.y >= size.z) & ~x;
        if ((z_axis == 0 ? x : z_axis == 1 ? y : kAll & ~x & ~y) != kAll) return false;
        shear_.kz = z_axis;
        return lane_bits(size[z_axis] >= Batch(1 / kLargestNumber)) == kAll;
    }

    // Computes the values of ShearedRay for all rays.
    Shear<Batch> sheared(const Vec3T<Batch>& origin, const Vec3T<Batch>& direction) {
        const std::size_t kz = shear_.kz, next = (kz + 1) % 3, after = (kz + 2) % 3;
        const std::size_t kx = negative_[kz] ? after : next, ky = negative_[kz] ? next : after;
        const Shear<Batch> shear{kx,
                                 ky,
                                 kz,
                                 {origin[kx], origin[ky], origin[kz]},
                                 direction[kx] / direction[kz],
                                 direction[ky] / direction[kz],
                                 Batch(1.0f) / direction[kz],
                                 xsimd::abs(direction[kz])};
        const Batch values[] = {shear.origin.x, shear.origin.y, shear.origin.z,   shear.sx,
                                shear.sy,       shear.sz,       shear.depth_per_t};
        for (std::size_t k = 0; k < std::size(values); ++k) values[k].store_aligned(lanes_[k].data());
        return shear;
    }

    // Prepares the slabs in the same way as SlabRay for one ray, with the largest error bound of all origins.
    void set_slabs(const Vec3T<Batch>& origin, const Vec3T<Batch>& direction, const Box3& bounds) {
        const Box3 origins = origin_ ? Box3{*origin_, *origin_} : extent_of(origin);
        const Vec3 extents = max(abs(bounds.low - origins.high), abs(bounds.high - origins.low)),
                   sizes = max(abs(origins.low), abs(origins.high));
        const float largest = max_component(extents);
        Vec3 ahead, behind;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float sign = negative_[axis] ? -1.0f : 1.0f;
            const float shift = SlabError::shift(extents[axis], largest, sizes[axis]) * sign;
            scale_[axis] =
                Batch(sign) / SlabError::divisor(xsimd::abs(direction[axis]), xsimd::abs(direction[shear_.kz]),
                                                 Batch(extents[axis] + sizes[axis]));
            near_offset_[axis] = -(origin[axis] + Batch(shift)) * scale_[axis];
            far_offset_[axis] = -(origin[axis] - Batch(shift)) * scale_[axis];
            ahead[axis] = (negative_[axis] ? origins.low[axis] : origins.high[axis]) + shift;
            behind[axis] = (negative_[axis] ? origins.high[axis] : origins.low[axis]) - shift;
        }
        const Lanes low(reduce_min_of_each(std::array{scale_[0], scale_[1], scale_[2], t_min_})),
            minus_high(reduce_min_of_each(std::array{-scale_[0], -scale_[1], -scale_[2], t_min_}));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            near_interval_[axis] = {low[axis], -minus_high[axis], ahead[axis]};
            far_interval_[axis] = {low[axis], -minus_high[axis], behind[axis]};
        }
        first_ = low[3];
    }
    static Box3 extent_of(const Vec3T<Batch>& points) {
        return {{reduce_min(points.x), reduce_min(points.y), reduce_min(points.z)},
                {reduce_max(points.x), reduce_max(points.y), reduce_max(points.z)}};
    }

    static constexpr unsigned kAllRays = (1u << kSize) - 1;

    bool coherent_;
    std::array<bool, 3> negative_;
    std::array<std::size_t, 3> near_plane_, far_plane_; // offsets in bytes from the node
    std::optional<Vec3> origin_;
    Shear<Batch> shear_;
    alignas(64) std::array<Values, 7> lanes_; // components of the shears, which shears() reads
    alignas(64) LineLanes<kSize> lines_;
    Batch t_min_, t_max_;
    float first_;
    std::array<Batch, 3> scale_, near_offset_, far_offset_;
    std::array<Interval, 3> near_interval_, far_interval_;
};

/// Holds the closest hits so far of a packet's rays. t is the ray's end if there is no hit.
struct PacketHits {
    static constexpr std::size_t kSize = RayPacket::kSize;
    template <typename T> using PerRay = std::array<T, kSize>;

    alignas(64) PerRay<float> t, u, v;
    alignas(64) PerRay<std::uint32_t> object, primitive;

    /// Starts without hits. `ends` are the greatest hit distances that count.
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

} // namespace duet::raytrace

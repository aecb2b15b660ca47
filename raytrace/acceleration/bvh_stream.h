// Rays that run anywhere, through a hierarchy of few nodes side by side: a ray alone waits at every box for what the
// last comparison says, and the processor guesses wrong where it goes. Here each step is done for all rays before the
// next one is, from lists that are written without a branch (like the ray streams of Tsakok 2009, «Faster Incoherent
// Rays: Multi-BVH Ray Stream Tracing»). No ray visits what is near first, so this is for hierarchies in which it meets few
// boxes in any order. The hits are those of `find_closest`, to the bit.
#pragma once

#include "raytrace/acceleration/bvh_traverse.h"

#include <span>

namespace duet::raytrace {

inline constexpr std::size_t kMostStreamedNodes = 64;
/// Whether rays may stream through a hierarchy: a tree of few nodes, of whose leaves most hold spheres, and none instances.
inline bool streamable(const Bvh& bvh) {
    return bvh.use_tree() && bvh.nodes.size() <= kMostStreamedNodes && bvh.instances.empty() &&
           bvh.spheres.size() > bvh.triangles.size() + bvh.quads.size();
}

/// Pairs of a ray and what it is to be tested against, by their numbers.
template <std::size_t kMost> class StreamPairs {
public:
    static constexpr std::size_t kLanes = kSimdLanes;

    std::size_t size() const { return size_; }
    /// Whether kLanes more fit.
    bool has_room() const { return size_ + kLanes <= kMost; }
    void clear() { size_ = 0; }
    std::uint32_t ray(std::size_t i) const { return rays_[i]; }
    std::uint32_t other(std::size_t i) const { return others_[i]; }
    const std::uint32_t* rays() const { return rays_.data(); }
    const std::uint32_t* others() const { return others_.data(); }

    void add(std::uint32_t ray, std::uint32_t other) {
        rays_[size_] = ray;
        others_[size_++] = other;
    }
    /// The ray with those of kLanes others whose bits are set.
    void add(std::uint32_t ray, const std::uint32_t* others, unsigned which) {
#if XSIMD_WITH_AVX512F
        const auto all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(others));
        const auto some = _mm256_maskz_compress_epi32(static_cast<__mmask8>(which), all);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(&others_[size_]), some);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(&rays_[size_]), _mm256_set1_epi32(static_cast<int>(ray)));
        size_ += static_cast<std::size_t>(std::popcount(which));
#else
        for (; which != 0; which &= which - 1) add(ray, others[std::countr_zero(which)]);
#endif
    }
    /// Fills the lanes up to a multiple of `count`, with the last pair; the size stays.
    void pad(std::size_t count) {
        for (std::size_t i = size_; i % count != 0; ++i) rays_[i] = rays_[size_ - 1], others_[i] = others_[size_ - 1];
    }

private:
    // Without values: nobody should clear them for each stream. More are written than are kept.
    std::array<std::uint32_t, kMost + kLanes> rays_, others_;
    std::size_t size_ = 0;
};

/// Up to kSize rays on their way through a streamable hierarchy.
class RayStream {
public:
    static constexpr std::size_t kSize = 64;

    /// hits: each ray's end, as `find_closest` has `best`; in the end what it has found, if anything.
    RayStream(const Bvh& bvh, std::span<const Ray> rays, std::span<Hit> hits) : bvh_(bvh), rays_(rays), hits_(hits) {}

    void run() {
        for (std::uint32_t i = 0; i < rays_.size(); ++i)
            if (traceable(rays_[i])) start(i);
        for (std::size_t i = 0; i < nodes_.size(); ++i) // there are more with each
            enter(nodes_.ray(i), BvhRef::from_bits(nodes_.other(i)));
        test_leaves();
        test_spheres();
    }

private:
    static constexpr std::size_t kLanes = kDoubleLanes; // of exact tests
    using Batch = FloatBatch<kBlockSize>;
    using Some = FloatBatch<kLanes>;
    struct NoInstance {
        bool operator()(const BvhInstance&, Hit&) const { return false; }
    };

    void start(std::uint32_t i) {
        const Ray& ray = rays_[i];
        slabs_[i] = SlabRay(ray, bvh_.bounds);
        scales_[i] = filter_scale(ray.direction);
        nodes_.add(i, BvhRef::node(0).bits());
    }

    void enter(std::uint32_t i, BvhRef ref) {
        if (!leaves_.has_room()) test_leaves();
        const BvhNode& node = node_at(bvh_, ref);
        const unsigned entered = slabs_[i].enter(node, Batch(rays_[i].t_min), Batch(hits_[i].t)).children;
        static_assert(sizeof(BvhRef) == sizeof(std::uint32_t));
        const auto* children = reinterpret_cast<const std::uint32_t*>(node.children.data());
        const unsigned leaves = leaf_children(children);
        nodes_.add(i, children, entered & ~leaves);
        leaves_.add(i, children, entered & leaves);
    }
    static unsigned leaf_children(const std::uint32_t* children) {
#if XSIMD_WITH_AVX
        return ~static_cast<unsigned>(_mm256_movemask_ps(_mm256_load_ps(reinterpret_cast<const float*>(children))));
#else
        unsigned leaves = 0;
        for (unsigned k = 0; k < BvhNode::kWidth; ++k) leaves |= unsigned{BvhRef::from_bits(children[k]).is_leaf()} << k;
        return leaves;
#endif
    }

    void test_leaves() {
        for (std::size_t k = 0; k < leaves_.size(); ++k) {
            const std::uint32_t i = leaves_.ray(k);
            const BvhRef leaf = BvhRef::from_bits(leaves_.other(k));
            if (leaf.kind() == PrimitiveKind::kSphere)
                filter(i, leaf.index());
            else
                LeafTest<false, NoInstance>(bvh_, rays_[i], kNoObject, NoInstance())(leaf, hits_[i]);
        }
        leaves_.clear();
    }

    // Spheres that the ray's line does not surely miss.
    void filter(std::uint32_t i, std::uint32_t index) {
        if (!spheres_.has_room()) test_spheres();
        const SphereBlock& block = bvh_.spheres[index];
        const Ray& ray = rays_[i];
        const auto along = [&](std::size_t axis) {
            return Batch::load_aligned(block.center[axis].data()) - Batch(ray.origin[axis]);
        };
        const Vec3T<Batch> direction(Batch(ray.direction.x), Batch(ray.direction.y), Batch(ray.direction.z));
        const unsigned met = may_meet<Batch>({along(0), along(1), along(2)}, direction, Batch(scales_[i]),
                                      Batch::load_aligned(block.radius.data()));
        alignas(32) static constexpr std::array<std::uint32_t, 8> kLanesOfBlock{0, 1, 2, 3, 4, 5, 6, 7};
        // as places of the centres' x in the list of blocks
        constexpr std::uint32_t kFloats = sizeof(SphereBlock) / sizeof(float);
        using Whole = xsimd::make_sized_batch_t<std::uint32_t, kBlockSize>;
        alignas(32) BlockLanes<std::uint32_t> places;
        (Whole::load_aligned(kLanesOfBlock.data()) + Whole(index * kFloats)).store_aligned(places.data());
        spheres_.add(i, places.data(), met);
    }

    // In double, as SphereBlockTest.
    void test_spheres() {
        if (spheres_.size() == 0) return;
        spheres_.pad(kLanes);
        for (std::size_t k = 0; k < spheres_.size(); k += kLanes) {
            const auto line = [&](std::size_t first) {
                return load_columns<kLanes>([&](std::size_t i) {
                    return reinterpret_cast<const float*>(&rays_[spheres_.ray(k + i)]) + first;
                });
            };
            const auto [ox, oy, oz, dx] = line(0);
            const auto [dy, dz, t_min, t_max] = line(4);
            const auto sphere = [&](std::size_t column) {
                return doubles(gathered(reinterpret_cast<const float*>(bvh_.spheres.data()) + column * kBlockSize,
                                        spheres_.others() + k));
            };
            const SphereTest<DoubleBatch> test(
                {sphere(0) - doubles(ox), sphere(1) - doubles(oy), sphere(2) - doubles(oz)},
                SphereLine<DoubleBatch>({doubles(dx), doubles(dy), doubles(dz)}), sphere(3));
            unsigned met = lane_bits(test.meets_ahead());
            if (met == 0) continue;
            const auto roots = test.roots();
            alignas(64) std::array<float, kLanes> near, far;
            store_floats(roots.near, near.data());
            store_floats(roots.far, far.data());
            met &= (1u << std::min(spheres_.size() - k, kLanes)) - 1;
            for (; met != 0; met &= met - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(met));
                consider(spheres_.ray(k + lane), spheres_.other(k + lane), near[lane], far[lane]);
            }
        }
        spheres_.clear();
    }
    void consider(std::uint32_t i, std::uint32_t place, float near, float far) {
        constexpr std::uint32_t kFloats = sizeof(SphereBlock) / sizeof(float);
        const Ray& ray = rays_[i];
        const float t = near > ray.t_min ? near : far;
        if (!(t > ray.t_min && t <= hits_[i].t)) return;
        const Hit hit{bvh_.spheres[place / kFloats].object[place % kFloats], 0, 0, 0, t};
        if (precedes(hit, hits_[i])) hits_[i] = hit;
    }
    static Some gathered(const float* from, const std::uint32_t* places) {
#if XSIMD_WITH_AVX512F
        return _mm256_i32gather_ps(from, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(places)), 4);
#endif
        alignas(sizeof(Some)) std::array<float, kLanes> lanes;
        for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = from[places[i]];
        return Some::load_aligned(lanes.data());
    }
    static DoubleBatch doubles(Some floats) {
#if XSIMD_WITH_AVX512F
        return _mm512_cvtps_pd(floats);
#endif
        alignas(sizeof(Some)) std::array<float, kLanes> lanes;
        floats.store_aligned(lanes.data());
        return load_doubles(lanes.data());
    }

    const Bvh& bvh_;
    const std::span<const Ray> rays_;
    const std::span<Hit> hits_;
    std::array<SlabRay, kSize> slabs_;
    std::array<float, kSize> scales_;
    StreamPairs<kSize * kMostStreamedNodes> nodes_; // no ray comes to one twice
    StreamPairs<512> leaves_, spheres_;             // those not tested yet
};

} // namespace duet::raytrace

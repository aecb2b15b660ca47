#include "raytrace/acceleration/bvh_stream.h"

#include "common/system/error.h"
#include "common/vec/widen.h"
#include "raytrace/acceleration/bvh_traverse.h"

#include <algorithm>
#include <cstddef>

namespace duet::raytrace {

#if XSIMD_WITH_AVX512F

namespace {

// A streamable hierarchy has at most this many nodes. No ray visits a node twice, so lists with room for this many
// nodes times the rays of a stream hold all possible pairs.
constexpr std::size_t kMaxNodes = 64;
// A ray may be expected to visit at most this many leaves of a streamable hierarchy. A single ray skips what lies
// behind its closest hit, but a stream does not, and so it loses where rays visit many leaves. Measurements: clouds
// of 100 to 2,000 spheres of 0.02 to 0.4 of the cloud's side, with and without a ground, Zen 5, rays from the
// spheres' surfaces. The time of a stream relative to single rays was 0.5 to 0.6 up to 4 expected leaves, 0.65 to
// 0.85 from 4 to 10, 0.8 to 1.2 from 10 to 18, and 1.0 to 1.4 beyond. (models/spheres.json has 2 expected leaves.)
constexpr double kMaxExpectedLeaves = 10;

// Returns how many leaves below `ref` a ray is expected to visit if it enters its box of half area `area`, by the
// SAH.
double expected_leaves(const Bvh& bvh, BvhRef ref, double area) {
    if (ref.is_leaf()) return 1;
    const BvhNode& node = node_at(bvh, ref);
    double leaves = 0;
    for (std::size_t i = 0; i < BvhNode::kWidth; ++i) {
        const Box3 box = node.box(i);
        if (box.empty()) continue;
        const double its_area = static_cast<double>(box.half_area());
        leaves += expected_leaves(bvh, node.children[i], its_area) * (its_area < area ? its_area / area : 1);
    }
    return leaves;
}
// Returns the expected number of leaves for rays that run among the small objects: they enter the union of the
// root's inner children. Without this rule, a ground that fills the root's box would make everything on it seem
// seldom visited.
double expected_leaves(const Bvh& bvh) {
    const BvhNode& root = bvh.nodes[0];
    Box3 inner;
    for (std::size_t i = 0; i < BvhNode::kWidth; ++i)
        if (!root.box(i).empty() && !root.children[i].is_leaf()) inner.extend(root.box(i));
    return expected_leaves(bvh, BvhRef::node(0), static_cast<double>((inner.empty() ? bvh.bounds : inner).half_area()));
}

/// Stores pairs of the index of a ray and the index of what it is to be tested against.
template <std::size_t kCapacity> class StreamPairs {
public:
    static constexpr std::size_t kLanes = kSimdLanes;

    std::size_t size() const { return size_; }
    /// Returns whether `times` · kLanes more pairs fit.
    bool has_room(std::size_t times) const { return size_ + times * kLanes <= kCapacity; }
    void clear() { size_ = 0; }
    std::uint32_t ray(std::size_t i) const { return rays_[i]; }
    std::uint32_t other(std::size_t i) const { return others_[i]; }
    const std::uint32_t* rays() const { return rays_.data(); }
    const std::uint32_t* others() const { return others_.data(); }

    void add(std::uint32_t ray, std::uint32_t other) {
        rays_[size_] = ray;
        others_[size_++] = other;
    }
    /// Appends many pairs, with their number in a register.
    class Writer {
    public:
        explicit Writer(StreamPairs& pairs) : pairs_(pairs), size_(pairs.size_) {}
        ~Writer() { pairs_.size_ = size_; }
        Writer(const Writer&) = delete;
        Writer& operator=(const Writer&) = delete;

        /// Appends the pairs of a ray and those of kLanes `others` whose bit in `indices` is set.
        void add(std::uint32_t ray, const std::uint32_t* others, unsigned which) {
            const auto all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(others));
            const auto some = _mm256_maskz_compress_epi32(static_cast<__mmask8>(which), all);
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(&pairs_.others_[size_]), some);
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(&pairs_.rays_[size_]),
                                _mm256_set1_epi32(static_cast<int>(ray)));
            size_ += static_cast<std::size_t>(std::popcount(which));
        }

    private:
        StreamPairs& pairs_;
        std::size_t size_;
    };
    /// Pads the arrays with the last pair up to a multiple of `count`. The size does not change.
    void pad(std::size_t count) {
        for (std::size_t i = size_; i % count != 0; ++i) rays_[i] = rays_[size_ - 1], others_[i] = others_[size_ - 1];
    }

private:
    // The arrays are not initialized, because that would clear them for each stream. Writers store up to kLanes
    // values more than they count.
    std::array<std::uint32_t, kCapacity + kLanes> rays_, others_;
    std::size_t size_ = 0;
};

/// Holds the slabs of up to kCapacity rays in structure-of-arrays layout; see SlabRay.
template <std::size_t kCapacity> class SlabRays {
public:
    using Batch = SlabRay::Batch;
    static constexpr std::size_t kLanes = BvhNode::kWidth; // number of a node's children, and of the rays set at once

    /// Sets the slabs of the rays from index `first` on, one ray per lane. Returns a bit mask of those that are
    /// `traceable`.
    unsigned set(std::size_t first, const Vec3T<Batch>& origin, const Vec3T<Batch>& direction, const Box3& bounds) {
        std::array<Batch, 3> extent;
        for (std::size_t axis = 0; axis < 3; ++axis)
            extent[axis] = Slabs<Batch>::extent(bounds.low[axis], bounds.high[axis], origin[axis]);
        const Batch greatest_extent = xsimd::max(xsimd::max(extent[0], extent[1]), extent[2]);
        const Batch greatest_size = max_component(abs(direction)), most(kLargestNumber);
        auto in_range = greatest_size >= Batch(1 / kLargestNumber);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Slabs<Batch> slabs(origin[axis], direction[axis], extent[axis], greatest_extent, greatest_size);
            in_range = in_range & (xsimd::abs(origin[axis]) <= most) & (xsimd::abs(direction[axis]) <= most);
            slabs.scale.store_aligned(&scale_[axis][first]);
            slabs.near.store_aligned(&near_[axis][first]);
            slabs.far.store_aligned(&far_[axis][first]);
            direction[axis].store_aligned(&sign_[axis][first]);
        }
        return lane_bits(in_range);
    }

    /// Returns a bit mask of the children that one of the rays enters; see SlabRay::enter.
    unsigned enter(std::size_t ray, const BvhNode& node, Batch t_min, Batch t_max) const {
        Batch near = t_min, far = t_max;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t high = std::bit_cast<std::uint32_t>(sign_[axis][ray]) >> 31;
            const auto slab = [&](std::size_t plane, float offset) {
                return multiply_add(Batch::load_aligned(node.planes[plane].data()), Batch(scale_[axis][ray]),
                                    Batch(offset));
            };
            near = xsimd::max(slab(axis + 3 * high, near_[axis][ray]), near);
            far = xsimd::min(slab(axis + 3 - 3 * high, far_[axis][ray]), far);
        }
        return lane_bits(near <= far);
    }

private:
    using PerRay = std::array<std::array<float, kCapacity>, 3>;
    alignas(sizeof(Batch)) PerRay scale_, near_, far_, sign_; // not initialized, like the pairs
};

/// Traverses a streamable hierarchy with up to kSize rays.
class RayStream {
public:
    static constexpr std::size_t kSize = 64;

    /// Takes the rays with the indices `indices`. run() finds for each what `find_closest` finds, and writes it to
    /// `hits` at the same index.
    RayStream(const Bvh& bvh, std::span<const Ray> rays, std::span<const std::uint32_t> indices, std::span<Hit> hits)
        : bvh_(bvh), rays_(rays), indices_(indices), hits_(hits) {
        DUET_CHECK_LE(indices.size(), kSize);
    }

    void run() {
        for (std::size_t i = 0; i < indices_.size(); i += kLanes) start(i);
        for (Pairs *level = &nodes_[0], *below = &nodes_[1]; level->size() > 0; std::swap(level, below)) {
            below->clear();
            for (std::size_t k = 0; k < level->size(); k += kChunk) enter(*level, k, *below);
        }
        test_leaves();
        test_spheres();
        for (std::size_t i = 0; i < indices_.size(); ++i) hits_[indices_[i]] = best_[i].valid() ? best_[i] : Hit();
    }

private:
    static constexpr std::size_t kLanes = kBlockSize;
    static constexpr std::size_t kChunk = 16; // number of pairs between checks of the room left
    static constexpr std::size_t kDoubles = kDoubleLanes; // lanes of the exact tests
    using Batch = FloatBatch<kLanes>;
    struct NoInstance {
        bool operator()(const BvhInstance&, Hit&) const { return false; }
    };

    using Pairs = StreamPairs<kSize * kMaxNodes>;
    using LeafPairs = StreamPairs<512>;
    std::array<Pairs, 2> nodes_; // pairs of the current level and of the one below
    LeafPairs leaves_, spheres_; // pairs that are not tested yet

    const Ray& ray(std::size_t i) const { return rays_[indices_[i]]; }
    static_assert(offsetof(Ray, origin) == 0 && offsetof(Ray, direction) == 3 * sizeof(float) &&
                  offsetof(Ray, t_min) == 6 * sizeof(float) && offsetof(Ray, t_max) == 7 * sizeof(float));
    // Loads the components of the N rays at(0) to at(N - 1): a batch per component.
    template <std::size_t N, typename At> static std::array<FloatBatch<N>, 8> columns(const At& at) {
        const auto four = [&](std::size_t first) {
            return load_columns<N>([&](std::size_t i) { return reinterpret_cast<const float*>(&at(i)) + first; });
        };
        const auto [ox, oy, oz, dx] = four(0);
        const auto [dy, dz, t_min, t_max] = four(4);
        return {ox, oy, oz, dx, dy, dz, t_min, t_max};
    }

    [[gnu::flatten]] void start(std::size_t first) {
        const std::size_t size = std::min(indices_.size() - first, kLanes);
        const auto [ox, oy, oz, dx, dy, dz, t_min, t_max] =
            columns<kLanes>([&](std::size_t i) -> const Ray& { return ray(first + (i < size ? i : 0)); });
        const Vec3T<Batch> direction(dx, dy, dz);
        unsigned traceable = slabs_.set(first, {ox, oy, oz}, direction, bvh_.bounds) & ((1u << size) - 1);
        filter_scale(direction).store_aligned(&scales_[first]);
        for (std::size_t i = first; i < first + size; ++i) {
            best_[i] = {};
            best_[i].t = min(ray(i).t_max, std::numeric_limits<float>::max()); // a distance that overflowed is no hit
        }
        for (; traceable != 0; traceable &= traceable - 1)
            nodes_[0].add(static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(std::countr_zero(traceable)),
                          BvhRef::node(0).bits());
    }

    // Tests up to kChunk pairs of one level of the tree, from index `first` on.
    void enter(const Pairs& level, std::size_t first, Pairs& below) {
        if (!leaves_.has_room(kChunk)) test_leaves();
        Pairs::Writer nodes(below);
        LeafPairs::Writer leaves(leaves_);
        const std::size_t end = std::min(first + kChunk, level.size());
        for (std::size_t k = first; k < end; ++k) {
            const std::uint32_t i = level.ray(k);
            const BvhNode& node = node_at(bvh_, BvhRef::from_bits(level.other(k)));
            const unsigned entered = slabs_.enter(i, node, Batch(ray(i).t_min), Batch(best_[i].t));
            static_assert(sizeof(BvhRef) == sizeof(std::uint32_t));
            const auto* children = reinterpret_cast<const std::uint32_t*>(node.children.data());
            const unsigned are_leaves = leaf_children(children);
            nodes.add(i, children, entered & ~are_leaves);
            leaves.add(i, children, entered & are_leaves);
        }
    }
    static unsigned leaf_children(const std::uint32_t* children) {
        return ~static_cast<unsigned>(_mm256_movemask_ps(_mm256_load_ps(reinterpret_cast<const float*>(children))));
    }

    void test_leaves() {
        for (std::size_t k = 0; k < leaves_.size(); k += kChunk) test_leaves(k, std::min(k + kChunk, leaves_.size()));
        leaves_.clear();
    }
    void test_leaves(std::size_t first, std::size_t end) {
        if (!spheres_.has_room(kChunk)) test_spheres();
        LeafPairs::Writer spheres(spheres_);
        for (std::size_t k = first; k < end; ++k) {
            const std::uint32_t i = leaves_.ray(k);
            const BvhRef leaf = BvhRef::from_bits(leaves_.other(k));
            if (leaf.kind() == PrimitiveKind::kSphere)
                filter(i, leaf.index(), spheres);
            else
                LeafTest<false, NoInstance>(bvh_, ray(i), kNoObject, NoInstance())(leaf, best_[i]);
        }
    }

    // Appends the spheres of a block that the ray's line may hit.
    [[gnu::always_inline]] void filter(std::uint32_t i, std::uint32_t index, LeafPairs::Writer& spheres) const {
        const SphereBlock& block = bvh_.spheres[index];
        const Ray& line = ray(i);
        const auto along = [&](std::size_t axis) {
            return Batch::load_aligned(block.center[axis].data()) - Batch(line.origin[axis]);
        };
        const unsigned hit_lanes = may_hit<Batch>({along(0), along(1), along(2)}, broadcast<Batch>(line.direction),
                                                  Batch(scales_[i]), Batch::load_aligned(block.radius.data()));
        using Whole = xsimd::make_sized_batch_t<std::uint32_t, kLanes>;
        alignas(32) static constexpr std::array<std::uint32_t, 8> kEach{0, 1, 2, 3, 4, 5, 6, 7};
        alignas(32) BlockLanes<std::uint32_t> offsets;
        (Whole::load_aligned(kEach.data()) + Whole(index * kBlockFloats)).store_aligned(offsets.data());
        spheres.add(i, offsets.data(), hit_lanes);
    }

    // Tests the listed spheres in double precision, as SphereBlockTest does.
    [[gnu::flatten]] void test_spheres() {
        if (spheres_.size() == 0) return;
        spheres_.pad(kDoubles);
        for (std::size_t k = 0; k < spheres_.size(); k += kDoubles) {
            const auto [ox, oy, oz, dx, dy, dz, t_min, t_max] =
                columns<kDoubles>([&](std::size_t i) -> const Ray& { return ray(spheres_.ray(k + i)); });
            const auto sphere = [&](std::size_t column) {
                return to_doubles(gathered(reinterpret_cast<const float*>(bvh_.spheres.data()) + column * kBlockSize,
                                        spheres_.others() + k));
            };
            const SphereTest<DoubleBatch> test(
                {sphere(0) - to_doubles(ox), sphere(1) - to_doubles(oy), sphere(2) - to_doubles(oz)},
                SphereTestLine<DoubleBatch>({to_doubles(dx), to_doubles(dy), to_doubles(dz)}), sphere(3));
            unsigned hit_lanes = lane_bits(test.hits_forward());
            if (hit_lanes == 0) continue;
            const auto roots = test.roots();
            const NarrowBatch near = to_floats(roots.near), far = to_floats(roots.far);
            const NarrowBatch t = xsimd::select(near > t_min, near, far);
            hit_lanes &= lane_bits(t > t_min) & ((1u << std::min(spheres_.size() - k, kDoubles)) - 1);
            const Lanes<NarrowBatch> distances(t);
            for (; hit_lanes != 0; hit_lanes &= hit_lanes - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(hit_lanes));
                consider(spheres_.ray(k + lane), spheres_.other(k + lane), distances[lane]);
            }
        }
        spheres_.clear();
    }
    void consider(std::uint32_t i, std::uint32_t offset, float t) {
        const Hit hit{bvh_.spheres[offset / kBlockFloats].object[offset % kBlockFloats], 0, 0, 0, t};
        if (precedes(hit, best_[i])) best_[i] = hit; // best_[i].t is the ray's end while there is no hit
    }

    static NarrowBatch gathered(const float* from, const std::uint32_t* offsets) {
        return _mm256_i32gather_ps(from, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(offsets)), 4);
    }

    // A sphere is identified by the index of its center's x among the floats of all blocks. Its y, z and radius
    // follow, each kBlockSize floats later.
    static_assert(offsetof(SphereBlock, center) == 0 && offsetof(SphereBlock, radius) == 3 * sizeof(BlockLanes<float>));
    static constexpr std::uint32_t kBlockFloats = sizeof(SphereBlock) / sizeof(float);

    const Bvh& bvh_;
    const std::span<const Ray> rays_;
    const std::span<const std::uint32_t> indices_;
    const std::span<Hit> hits_;
    SlabRays<kSize> slabs_;
    alignas(64) std::array<float, kSize> scales_; // values of filter_scale
    std::array<Hit, kSize> best_;
};

} // namespace

bool streamable(const Bvh& bvh) {
    return bvh.use_tree() && bvh.nodes.size() <= kMaxNodes && bvh.instances.empty() &&
           bvh.spheres.size() > bvh.triangles.size() + bvh.quads.size() && expected_leaves(bvh) <= kMaxExpectedLeaves;
}

void find_closest_of_stream(const Bvh& bvh, std::span<const Ray> rays, std::span<const std::uint32_t> indices,
                            std::span<Hit> hits) {
    for (; !indices.empty(); indices = indices.subspan(std::min(indices.size(), RayStream::kSize)))
        RayStream(bvh, rays, indices.first(std::min(indices.size(), RayStream::kSize)), hits).run();
}

#else // without AVX-512

bool streamable(const Bvh&) { return false; }
void find_closest_of_stream(const Bvh&, std::span<const Ray>, std::span<const std::uint32_t>, std::span<Hit>) {
    DUET_CHECK(false); // no hierarchy is streamable
}

#endif

} // namespace duet::raytrace

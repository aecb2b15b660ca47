// Tests rays against the polygons of a leaf with SIMD. The results are bit-equal to those of intersect_triangle and
// intersect_quad.
#pragma once

#include "common/geometry/quad.h"
#include "common/geometry/triangle.h"
#include "raytrace/acceleration/bvh.h"

#include <bit>

namespace duet::raytrace {

/// Tests rays against triangles or quads, one pair per lane, in float. The cases that intersect_triangle decides in
/// double precision are left to it.
template <typename Batch> class CandidateTest {
public:
    /// Tests one ray against many polygons, or many rays against one polygon. `ends` are the greatest hit distances
    /// that count.
    template <typename S, typename Vertex>
    [[gnu::always_inline]] CandidateTest(const Shear<S>& ray, const std::array<Vertex, 3>& p, Batch ends) {
        test({ray, p[0], p[1], p[2]}, ray.depth_per_t, ends, 0);
        first_half_ = Lanes(true);
    }
    template <typename S, typename Vertex>
    [[gnu::always_inline]] CandidateTest(const Shear<S>& ray, const std::array<Vertex, 4>& p, Batch ends) {
        using Test = TriangleTest<Batch>;
        const Vec3T<Batch> a = Test::sheared(ray, p[0]), b = Test::sheared(ray, p[1]), c = Test::sheared(ray, p[2]),
                           d = Test::sheared(ray, p[3]);
        const Batch ba = Test::edge(b, a), cb = Test::edge(c, b), dc = Test::edge(d, c), ad = Test::edge(a, d);
        // The diagonal is an edge of both halves, abc and acd. A ray therefore hits at most one half, unless it
        // passes through the diagonal. In that case, and where rounding has folded the quad, intersect_quad decides.
        const Batch ac = Test::edge(a, c), ca = -ac;
        const auto first = same_sign(cb, ac, ba), second = same_sign(dc, ad, ca);
        const auto half = [&](const auto& of_first, const auto& of_second) {
            return select(first, of_first, of_second);
        };
        test({a, half(b, c), half(c, d), half(cb, dc), half(ac, ad), half(ba, ca)}, ray.depth_per_t, ends,
             lane_bits(first & second));
        if (candidates_ == 0) return;
        first_half_ = first;
        const Batch sum = xsimd::min(u_ + v_, Batch(1.0f));
        u_ = half(sum, u_);
        v_ = half(v_, sum);
    }

    /// Returns a bit mask of the lanes that may have a hit before the end. It contains every lane with a hit, and
    /// few others.
    unsigned candidates() const { return candidates_; }
    /// Returns a bit mask of the candidates whose hit is exactly t, u and v, provided that t is within the ray's
    /// range.
    unsigned certain() const { return certain_ & candidates_; }
    /// Returns a bit mask of the candidates that are hit at u and v, but so close to the ray's origin that
    /// plane_distance must compute the distance. Most of these rays leave the polygon. intersect_triangle or
    /// intersect_quad must decide the candidates that are neither certain nor need a distance.
    unsigned needs_distance() const { return needs_distance_ & candidates_; }
    /// Sets the distances of all lanes that need one, whose hits become certain.
    [[gnu::always_inline]] void set_distances(Batch distances) {
        t_ = xsimd::select(needs_distance_lanes_, distances, t_);
        certain_ |= needs_distance_;
        needs_distance_ = 0;
    }
    Batch t() const { return t_; }
    Batch u() const { return u_; }
    Batch v() const { return v_; }
    using Lanes = typename Batch::batch_bool_type;
    /// Returns the lanes whose quad is hit in its first half, abc. For triangles it returns all lanes.
    Lanes first_half() const { return first_half_; }

private:
    static Lanes same_sign(Batch a, Batch b, Batch c) {
        return (xsimd::min(xsimd::min(a, b), c) >= Batch(0.0f)) | (xsimd::max(xsimd::max(a, b), c) <= Batch(0.0f));
    }

    // `unsure` is a bit mask of lanes that the distance test must not reject, and whose hits are never certain.
    template <typename S>
    [[gnu::always_inline]] void test(const TriangleTest<Batch>& test, const S& depth_per_t, Batch ends,
                                     unsigned unsure) {
        const Batch zero(0.0f);
        const Batch low = xsimd::min(xsimd::min(test.e0, test.e1), test.e2);
        const Batch high = xsimd::max(xsimd::max(test.e0, test.e1), test.e2);
        candidates_ = lane_bits((low >= zero) | (high <= zero));
        if (candidates_ == 0) return;
        const Batch inv_det = Batch(1.0f) / test.det();
        const Batch t = test.distance(inv_det), error = test.distance_error(inv_det, depth_per_t);
        unsure |= lane_bits(test.is_needle(inv_det, depth_per_t));
        const auto outside = (t < -error) | (t - error > ends); // false for NaN
        candidates_ &= ~lane_bits(outside) | unsure;
        if (candidates_ == 0) return;
        const auto inside = (low > zero) | (high < zero);
        certain_ = lane_bits(inside & (xsimd::abs(t) > error)) & ~unsure;
        needs_distance_lanes_ = inside & (xsimd::abs(t) <= error);
        needs_distance_ = lane_bits(needs_distance_lanes_) & ~unsure;
        t_ = t;
        u_ = test.e1 * inv_det;
        v_ = test.e2 * inv_det;
    }

    unsigned candidates_, certain_ = 0, needs_distance_ = 0;
    Lanes needs_distance_lanes_, first_half_; // uninitialized if there are no candidates
    Batch t_, u_, v_;
};

/// Tests one ray against all polygons of a block.
template <std::size_t kCorners> class BlockTest : public CandidateTest<FloatBatch<kBlockSize>> {
public:
    [[gnu::always_inline]] BlockTest(const Shear<float>& ray, const PolygonBlock<kCorners>& block, float end)
        : CandidateTest(ray, vertices(block, std::make_index_sequence<kCorners>()), Batch(end)) {}

    /// Computes the distances of the polygons that need one. `ray` and `block` must be those given to the constructor.
    [[gnu::always_inline]] void compute_distances(const ShearedRay& ray, const PolygonBlock<kCorners>& block) {
        Batch distances = plane_distances(ray, block.corner[0], block.corner[1], block.corner[2]);
        if constexpr (kCorners == 4)
            distances = xsimd::select(this->first_half(), distances,
                                      plane_distances(ray, block.corner[0], block.corner[2], block.corner[3]));
        this->set_distances(distances);
    }

private:
    using Batch = FloatBatch<kBlockSize>;
    using Corner = std::array<BlockLanes<float>, 3>; // [axis][polygon]

    struct Vertex {
        const Corner* axes;
        Batch operator[](std::size_t axis) const { return Batch::load_aligned((*axes)[axis].data()); }
    };
    template <std::size_t... i>
    static std::array<Vertex, kCorners> vertices(const PolygonBlock<kCorners>& block, std::index_sequence<i...>) {
        return {Vertex{&block.corner[i]}...};
    }

    [[gnu::always_inline]] static Batch plane_distances(const ShearedRay& ray, const Corner& a, const Corner& b,
                                                        const Corner& c) {
        using Double = DoubleBatch;
        const auto origin = broadcast<Double>(Vec3d(ray.origin)), direction = broadcast<Double>(Vec3d(ray.direction));
        alignas(sizeof(Batch)) BlockLanes<float> distances;
        for (std::size_t i = 0; i < kBlockSize; i += kDoubleLanes) {
            const auto at = [i](const Corner& p) {
                return Vec3T<Double>(load_doubles(p[0].data() + i), load_doubles(p[1].data() + i),
                                     load_doubles(p[2].data() + i));
            };
            store_floats(plane_distance(origin, direction, at(a), at(b), at(c)), distances.data() + i);
        }
        return Batch::load_aligned(distances.data());
    }
};

/// Returns where the ray hits one polygon of a block before the ray's end, by the exact scalar test.
inline std::optional<TriangleHit> exact_hit(const ShearedRay& ray, const TriangleBlock& block, std::size_t lane) {
    const auto [a, b, c] = block.corners(lane);
    return intersect_triangle(ray, a, b, c);
}
inline std::optional<TriangleHit> exact_hit(const ShearedRay& ray, const QuadBlock& block, std::size_t lane) {
    return intersect_quad(ray, block.corners(lane));
}

} // namespace duet::raytrace

// Rays against the primitives of leaves.
#pragma once

#include "common/geometry/hit.h"
#include "common/geometry/quad.h"
#include "common/geometry/sphere.h"
#include "common/geometry/triangle.h"
#include "common/system/sabotage.h"
#include "raytrace/acceleration/bvh.h"

#include <bit>
#include <optional>

namespace duet::raytrace {

/// The order of hits along a ray: by distance, and at equal distance by (object, primitive).
inline bool precedes(const Hit& a, const Hit& b) {
    if (a.t != b.t || sabotaged(Guard::kTieOrder)) return a.t < b.t;
    return a.object != b.object ? a.object < b.object : a.primitive < b.primitive;
}

/// Triangles against rays, a pair a lane. What intersect_triangle decides in double is left to it, so that the result
/// is the same to the bit.
template <typename Batch> class CandidateTest {
public:
    /// Of one ray and many triangles or the other way round; ends: of the rays.
    template <typename S, typename Vertex>
    [[gnu::always_inline]] CandidateTest(const Shear<S>& ray, const Vertex& a, const Vertex& b, const Vertex& c,
                                         Batch ends) {
        const TriangleTest<Batch> test(ray, a, b, c);
        const Batch zero(0.0f);
        const Batch low = xsimd::min(xsimd::min(test.e0, test.e1), test.e2);
        const Batch high = xsimd::max(xsimd::max(test.e0, test.e1), test.e2);
        candidates_ = lane_bits((low >= zero) | (high <= zero));
        if (candidates_ == 0) return;
        const Batch inv_det = Batch(1.0f) / test.det();
        const Batch t = test.distance(inv_det), error = test.distance_error(inv_det);
        const unsigned needles = lane_bits(test.is_needle(inv_det));
        const auto outside = (t < -error) | (t - error > ends); // and not NaN
        candidates_ &= ~lane_bits(outside) | needles;
        if (candidates_ == 0) return;
        certain_ = lane_bits((xsimd::abs(t) > error) & ((low > zero) | (high < zero))) & ~needles;
        t_ = t;
        u_ = test.e1 * inv_det;
        v_ = test.e2 * inv_det;
    }

    /// The lanes with a hit before the end, a bit each: all of them, and hardly any other.
    unsigned candidates() const { return candidates_; }
    /// The candidates that are hit just as t, u and v say, if that is within the ray's range; of the others
    /// intersect_triangle has to say.
    unsigned certain() const { return certain_ & candidates_; }
    Batch t() const { return t_; }
    Batch u() const { return u_; }
    Batch v() const { return v_; }

private:
    unsigned candidates_, certain_;
    Batch t_, u_, v_;
};

/// The triangles of a block against one ray, all at once.
class BlockTest : public CandidateTest<FloatBatch<TriangleBlock::kSize>> {
public:
    [[gnu::always_inline]] BlockTest(const Shear<float>& ray, const TriangleBlock& block, float end)
        : CandidateTest(ray, Vertex{block.corner[0]}, Vertex{block.corner[1]}, Vertex{block.corner[2]}, Batch(end)) {}

private:
    using Batch = FloatBatch<TriangleBlock::kSize>;
    struct Vertex {
        const std::array<TriangleBlock::Lanes<float>, 3>& axes;
        Batch operator[](std::size_t axis) const { return Batch::load_aligned(axes[axis].data()); }
    };
};

/// Tests leaves against one ray. With kAny a test ends at the first hit that comes before the best and is not the
/// best's own primitive. `instance(i, best)` is asked for instances' hits.
template <bool kAny, typename Instance> class LeafTest {
public:
    /// object: of the primitives where it is not kNoObject (an instance's), else they name their own.
    LeafTest(const Bvh& bvh, const Ray& ray, std::uint32_t object, const Instance& instance)
        : bvh_(bvh), ray_(ray), sheared_(ray), object_(object), instance_(instance) {}

    bool found() const { return found_; } ///< whether any test has found a hit

    /// Leaves in `best` what comes first of it and the leaf's hits. True where the search is over.
    [[gnu::always_inline]] bool operator()(BvhRef leaf, Hit& best) {
        const std::uint32_t end = leaf.index() + leaf.count();
        if (leaf.kind() == PrimitiveKind::kTriangle) {
            for (std::uint32_t i = leaf.index(); i < end; ++i)
                if (triangles(bvh_.triangles[i], best)) return true;
            return false;
        }
        return others(leaf, end, best);
    }

private:
    [[gnu::always_inline]] bool triangles(const TriangleBlock& block, Hit& best) {
        const BlockTest test(sheared_.shear, block, best.t);
        if (test.candidates() == 0) return false;
        if constexpr (kAny) {
            using Batch = FloatBatch<TriangleBlock::kSize>;
            const unsigned within = lane_bits((test.t() > Batch(sheared_.t_min)) & (test.t() < Batch(best.t)));
            for (unsigned lanes = test.certain() & within; lanes != 0; lanes &= lanes - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
                if (name(block.object[lane]) != best.object || block.primitive[lane] != best.primitive) return true;
            }
        }
        const Lanes t(test.t()), u(test.u()), v(test.v());
        for (unsigned lanes = test.candidates(); lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            sheared_.t_max = best.t;
            if (test.certain() >> lane & 1) {
                if (!(t[lane] > sheared_.t_min && t[lane] <= sheared_.t_max)) continue;
                if (consider(block, lane, {t[lane], u[lane], v[lane]}, best)) return true;
            } else if (const auto hit = intersect_triangle(sheared_, block.vertex(0, lane), block.vertex(1, lane),
                                                           block.vertex(2, lane))) {
                if (consider(block, lane, *hit, best)) return true;
            }
        }
        return false;
    }

    [[gnu::noinline]] bool others(BvhRef leaf, std::uint32_t end, Hit& best) {
        for (std::uint32_t i = leaf.index(); i < end; ++i) {
            if (leaf.kind() == PrimitiveKind::kQuad) {
                const BvhQuad& p = bvh_.quads[i];
                sheared_.t_max = best.t;
                if (const auto hit = intersect_quad(sheared_, p.quad))
                    if (consider({name(p.object), p.primitive, hit->u, hit->v, hit->t}, best)) return true;
            } else if (leaf.kind() == PrimitiveKind::kSphere) {
                const BvhSphere& p = bvh_.spheres[i];
                ray_.t_max = best.t;
                if (const auto t = intersect_sphere(ray_, p.sphere))
                    if (consider({name(p.object), p.primitive, 0, 0, *t}, best)) return true;
            } else if (instance_(bvh_.instances[i], best)) {
                found_ = true;
                if (kAny) return true;
            }
        }
        return false;
    }

    bool consider(const TriangleBlock& block, std::size_t lane, const TriangleHit& hit, Hit& best) {
        return consider({name(block.object[lane]), block.primitive[lane], hit.u, hit.v, hit.t}, best);
    }
    bool consider(const Hit& hit, Hit& best) {
        if (!precedes(hit, best)) return false;
        if (kAny && hit.object == best.object && hit.primitive == best.primitive) return false;
        found_ = true;
        if (!kAny) best = hit;
        return kAny;
    }
    std::uint32_t name(std::uint32_t own) const { return object_ == kNoObject ? own : object_; }

    const Bvh& bvh_;
    Ray ray_;
    ShearedRay sheared_;
    std::uint32_t object_;
    const Instance& instance_;
    bool found_ = false;
};

} // namespace duet::raytrace

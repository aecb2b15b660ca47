// Declares LeafTest, which tests a ray against the primitives of leaves.
#pragma once

#include "common/geometry/hit.h"
#include "common/scene/alpha_mask.h"
#include "raytrace/acceleration/bvh_block.h"
#include "raytrace/acceleration/bvh_spheres.h"

#include <optional>

namespace duet::raytrace {

/// Returns whether hit a comes before hit b along a ray: by distance, and at equal distance by (object, primitive).
inline bool precedes(const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    return a.object != b.object ? a.object < b.object : a.primitive < b.primitive;
}

/// Decides which hits of a ray count in a scene with alpha masks: only hits that the ray does not pass through.
struct AlphaFilter {
    const Scene& scene;
    const Ray& ray; ///< in world space

    bool rejects(const Hit& hit) const { return passes_alpha_mask(scene, ray, hit); }
};

/// Tests leaves against one ray. With kAny, the search ends at the first hit that precedes `best` and is not on its
/// primitive. `instance(i, best)` is called to find the hits of instances.
template <bool kAny, typename Instance> class LeafTest {
public:
    /// If `object` is not kNoObject (inside an instance), hits report `object`. Otherwise they report the primitive's
    /// own object. If `alpha` is null, all hits count.
    LeafTest(const Bvh& bvh, const Ray& ray, std::uint32_t object, const Instance& instance,
             const AlphaFilter* alpha = nullptr)
        : bvh_(bvh), object_(object), instance_(instance), alpha_(alpha) {
        if (bvh.has_polygons()) sheared_.emplace(ray);
        if (!bvh.spheres.empty()) sphere_ray_.emplace(ray);
    }

    bool found() const { return found_; } ///< whether any test has found a hit

    /// Tests a leaf. Without kAny, `best` becomes the first of itself and the leaf's hits. Returns true if the
    /// search is over.
    [[gnu::always_inline]] bool operator()(BvhRef leaf, Hit& best) {
        if (leaf.kind() == PrimitiveKind::kTriangle) return test_polygons(bvh_.triangles[leaf.index()], best);
        return test_others(leaf, best);
    }

private:
    // This function is not inlined, which keeps the loop for scenes of triangles small.
    [[gnu::noinline]] bool test_others(BvhRef leaf, Hit& best) {
        if (leaf.kind() == PrimitiveKind::kQuad) return test_polygons(bvh_.quads[leaf.index()], best);
        if (leaf.kind() == PrimitiveKind::kSphere) return test_spheres(bvh_.spheres[leaf.index()], best);
        if (!instance_(bvh_.instances[leaf.index()], best)) return false;
        found_ = true;
        return kAny;
    }

    template <std::size_t kCorners>
    [[gnu::always_inline]] bool test_polygons(const PolygonBlock<kCorners>& block, Hit& best) {
        BlockTest<kCorners> test(sheared_->shear, block, best.t);
        if (test.candidates() == 0) return false;
        if (test.needs_distance() != 0) test.compute_distances(*sheared_, block);
        using Batch = FloatBatch<kBlockSize>;
        const unsigned hits =
            test.certain() & lane_bits((test.t() > Batch(sheared_->t_min)) & (test.t() <= Batch(best.t)));
        if (hits != 0) {
            const Lanes t(test.t()), u(test.u()), v(test.v());
            for (const std::size_t lane : SetBits(hits)) {
                if (consider(block, lane, {t[lane], u[lane], v[lane]}, best)) return true;
            }
        }
        for (const std::size_t lane : SetBits(test.candidates() & ~test.certain()))
            if (test_exactly(block, lane, best)) return true;
        return false;
    }

    template <typename Block> [[gnu::noinline]] bool test_exactly(const Block& block, std::size_t lane, Hit& best) {
        sheared_->t_max = best.t;
        const auto hit = exact_hit(*sheared_, block, lane);
        return hit && consider(block, lane, *hit, best);
    }

    bool test_spheres(const SphereBlock& block, Hit& best) {
        const SphereBlockTest test(*sphere_ray_, block, best.t);
        for (const std::size_t lane : SetBits(test.hits())) {
            Hit hit{reported_object(block.object[lane]), 0, 0, 0, test.t(lane)};
            if (!counts(hit, best)) continue;
            if (is_transparent(hit)) {
                if (!move_to_far_side(block.sphere(lane), best.t, hit) || !counts(hit, best) || is_transparent(hit))
                    continue;
            }
            if (accept(hit, best)) return true;
        }
        return false;
    }
    // Moves a hit on the near side of a sphere to the far side. Returns false if the ray starts inside or ends before.
    bool move_to_far_side(const Sphere& sphere, float end, Hit& hit) const {
        Ray rest = sphere_ray_->ray;
        rest.t_min = hit.t;
        rest.t_max = end;
        const auto far = intersect_sphere(rest, sphere);
        if (far) hit.t = *far;
        return far.has_value();
    }

    template <typename Block> bool consider(const Block& block, std::size_t lane, const TriangleHit& hit, Hit& best) {
        return consider({reported_object(block.object[lane]), block.primitive[lane], hit.u, hit.v, hit.t}, best);
    }
    bool consider(const Hit& hit, Hit& best) { return counts(hit, best) && !is_transparent(hit) && accept(hit, best); }
    // Returns whether an opaque hit would replace `best`.
    static bool counts(const Hit& hit, const Hit& best) {
        return precedes(hit, best) && !(kAny && hit.object == best.object && hit.primitive == best.primitive);
    }
    bool accept(const Hit& hit, Hit& best) {
        found_ = true;
        if (!kAny) best = hit;
        return kAny;
    }
    bool is_transparent(const Hit& hit) const { return alpha_ != nullptr && alpha_->rejects(hit); }
    std::uint32_t reported_object(std::uint32_t own) const { return object_ == kNoObject ? own : object_; }

    const Bvh& bvh_;
    std::optional<ShearedRay> sheared_; // used for polygons
    std::optional<SphereRay> sphere_ray_; // used for spheres
    std::uint32_t object_;
    const Instance& instance_;
    const AlphaFilter* alpha_;
    bool found_ = false;
};

} // namespace duet::raytrace

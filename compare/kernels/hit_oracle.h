// This file decides by a double-precision ray which of two kernels is right, or that single precision cannot decide it.
#pragma once

#include "common/scene/scene.h"
#include "compare/hits/reference_tracer.h"
#include "compare/kernels/tracer.h"

#include <memory>
#include <mutex>

namespace duet::compare {

/// Selects the verdict on one result.
enum class AnswerVerdict : std::uint8_t {
    kCorrect,  ///< confirmed by the double-precision ray
    kTie,      ///< another triangle is hit at the same distance
    kEdge,     ///< within rounding of a silhouette or of the ray's ends: hit and miss are both acceptable
    kEdgeLeak, ///< within rounding of an edge where the surface continues: the ray slipped through between triangles
    kWrong,
};

/// Judges results for a scene of meshes.
class HitOracle {
public:
    /// Positions closer than this fraction of their magnitude (distance plus the largest coordinate of the
    /// ray's origin) count as equal. It is about 80 roundings of single precision.
    static constexpr double kTolerance = 1e-5;

    explicit HitOracle(const Scene& scene) : scene_(scene) {}

    /// Judges a closest hit, or a miss, by tracing the ray in double precision.
    AnswerVerdict closest(const Ray& ray, const RayResult& ray_result) const;
    /// Judges a closest hit, for a caller that already knows the double-precision ray's first hit.
    AnswerVerdict closest(const Ray& ray, const RayResult& ray_result, const ReferenceHit& first) const;
    /// Returns the first hit of the ray in double precision.
    ReferenceHit first_hit(const Ray& ray) const;
    /// Judges a shadow ray that ends at t_max and may be blocked by anything.
    AnswerVerdict occluded(const Ray& ray, bool blocked) const;
    /// Judges a shadow ray that ends on a triangle that does not block it (`Accelerator::occluded`), or at a
    /// given distance.
    AnswerVerdict occluded(const Ray& ray, const Hit& end, bool blocked) const;

    /// Returns the double-precision tracer, whose tree is built on the first call.
    const ReferenceTracer& exact() const;

private:
    bool is_nearly_occluded(const Rayd& ray, const Hit& end) const;
    bool hits_within_rounding(const Rayd& ray, const RayResult& ray_result) const;
    bool is_near_ray_end(const Rayd& ray, const ReferenceHit& hit) const;
    bool is_near_edge(const Rayd& ray, const ReferenceHit& hit) const;
    bool surface_continues_around(const Rayd& ray, const ReferenceHit& hit, double end) const;

    const Scene& scene_;
    mutable std::once_flag once_;
    mutable std::unique_ptr<const ReferenceTracer> exact_;
};

/// Counts the results of a kernel that were judged, and those that count against it.
struct KernelErrors {
    std::int64_t rays = 0;
    std::int64_t edge = 0;  ///< AnswerVerdict::kEdgeLeak; a watertight kernel has none
    std::int64_t wrong = 0; ///< AnswerVerdict::kWrong

    void count(AnswerVerdict finding) {
        ++rays;
        edge += finding == AnswerVerdict::kEdgeLeak;
        wrong += finding == AnswerVerdict::kWrong;
    }
    KernelErrors& operator+=(const KernelErrors& other) {
        rays += other.rays;
        edge += other.edge;
        wrong += other.wrong;
        return *this;
    }
    bool any() const { return edge > 0 || wrong > 0; }
};

/// Counts the rays on which two kernels differ, by explanation. Hits of the same triangle at distances within
/// HitOracle::kTolerance count as equal.
struct Mismatches {
    std::int64_t rays = 0;                                      ///< rays that both kernels traced
    std::int64_t tie = 0, edge = 0, fault = 0, unexplained = 0; ///< rays by the worse of the two findings
    KernelErrors ours, peer;                                    ///< findings for the results that differ, per kernel

    std::int64_t differ() const { return tie + edge + fault + unexplained; }
};

/// Holds a set of rays and the query for each: the closest hit or, if there are ends, whether anything occludes the
/// ray. The peer's shadow rays simply end at their t_max.
struct RayQueries {
    std::span<const Ray> rays;
    std::span<const Hit> ends; ///< one per shadow ray, or none

    bool closest() const { return ends.empty(); }
};
/// Judges both results of each ray on which they differ.
Mismatches compare_results(const HitOracle& oracle, const RayQueries& ray_queries, std::span<const RayResult> ours,
                           std::span<const RayResult> peers, int threads);

/// Judges every `stride`-th of Duet's own results.
KernelErrors check_answers(const HitOracle& oracle, const RayQueries& ray_queries,
                           std::span<const RayResult> ray_results, std::size_t stride, int threads);

} // namespace duet::compare

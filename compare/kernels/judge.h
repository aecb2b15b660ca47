// Decides by a double-precision ray which of two kernels is right, or that single precision cannot decide it.
#pragma once

#include "common/scene/scene.h"
#include "compare/hits/exact_trace.h"
#include "compare/kernels/tracer.h"

#include <memory>
#include <mutex>

namespace duet::compare {

/// The judgment of one answer.
enum class Finding : std::uint8_t {
    kRight, ///< confirmed by the double-precision ray
    kTie,   ///< another triangle is hit at the same distance
    kEdge,  ///< within rounding of a silhouette or of the ray's ends: hit and miss are both acceptable
    kFault, ///< within rounding of an edge where the surface continues: the ray slipped through between triangles
    kWrong,
};

/// Judges answers for a scene of meshes.
class Judge {
public:
    /// Positions closer than this fraction of their magnitude (distance plus the largest coordinate of the
    /// ray's origin) count as equal. It is about 80 roundings of single precision.
    static constexpr double kTolerance = 1e-5;

    explicit Judge(const Scene& scene) : scene_(scene) {}

    Finding closest(const Ray& ray, const Answer& answer) const;
    /// Judges a closest hit, for a caller that already knows the double-precision ray's first hit.
    Finding closest(const Ray& ray, const Answer& answer, const ExactHit& first) const;
    ExactHit first_hit(const Ray& ray) const;
    /// Judges a shadow ray that ends at t_max and may be blocked by anything.
    Finding occluded(const Ray& ray, bool blocked) const;
    /// Judges a shadow ray that ends on a triangle that does not block it (`Accelerator::occluded`), or at a
    /// given distance.
    Finding occluded(const Ray& ray, const Hit& end, bool blocked) const;

    /// Returns the double-precision tracer, whose tree is built on the first call.
    const ExactTracer& exact() const;

private:
    bool nearly_occluded(const Rayd& ray, const Hit& end) const;
    bool nearly_meets(const Rayd& ray, const Answer& answer) const;
    bool at_an_end(const Rayd& ray, const ExactHit& hit) const;
    bool at_an_edge(const Rayd& ray, const ExactHit& hit) const;
    bool goes_on_around(const Rayd& ray, const ExactHit& hit, double end) const;

    const Scene& scene_;
    mutable std::once_flag once_;
    mutable std::unique_ptr<const ExactTracer> exact_;
};

/// Number of a kernel's answers that were judged, and of those that count against it.
struct Faults {
    std::int64_t rays = 0;
    std::int64_t edge = 0;  ///< Finding::kFault; a watertight kernel has none
    std::int64_t wrong = 0; ///< Finding::kWrong

    void count(Finding finding) {
        ++rays;
        edge += finding == Finding::kFault;
        wrong += finding == Finding::kWrong;
    }
    Faults& operator+=(const Faults& other) {
        rays += other.rays;
        edge += other.edge;
        wrong += other.wrong;
        return *this;
    }
    bool any() const { return edge > 0 || wrong > 0; }
};

/// The rays on which two kernels differ, by explanation. Hits of the same triangle at distances within
/// Judge::kTolerance count as equal.
struct Mismatches {
    std::int64_t rays = 0; ///< rays that both traced
    std::int64_t tie = 0, edge = 0, fault = 0, unexplained = 0; ///< by the worse of the two findings
    Faults ours, peer; ///< findings for the answers that differ, per kernel

    std::int64_t differ() const { return tie + edge + fault + unexplained; }
};

/// A set of rays and the query for each: the closest hit or, if there are ends, whether anything occludes the
/// ray. The peer's shadow rays simply end at their t_max.
struct Questions {
    std::span<const Ray> rays;
    std::span<const Hit> ends; ///< one per shadow ray, or none

    bool closest() const { return ends.empty(); }
};
Mismatches compare_answers(const Judge& judge, const Questions& questions, std::span<const Answer> ours,
                           std::span<const Answer> peers, int threads);

/// Judges every `stride`-th of Duet's own answers.
Faults judge_answers(const Judge& judge, const Questions& questions, std::span<const Answer> answers,
                     std::size_t stride, int threads);

} // namespace duet::compare

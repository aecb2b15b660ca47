// Who is right where two kernels differ? A double-precision ray decides, or finds that single precision cannot.
#pragma once

#include "common/scene/scene.h"
#include "compare/hits/exact_trace.h"
#include "compare/kernels/tracer.h"

#include <memory>
#include <mutex>

namespace duet::compare {

/// What is to be said of one answer.
enum class Finding : std::uint8_t {
    kRight, ///< the double-precision ray says so, too
    kTie,   ///< another triangle is met at the same distance
    kEdge,  ///< within rounding of an outline or of the ray's ends: hit and miss are both right
    kFault, ///< within rounding of an edge, but the surface goes on beyond it: the ray slipped through between triangles
    kWrong,
};

/// Judges answers for a scene of meshes.
class Judge {
public:
    /// Places nearer than this part of their size (distance plus the largest coordinate of the ray's origin) count as
    /// one: some 80 roundings of single precision.
    static constexpr double kTolerance = 1e-5;

    explicit Judge(const Scene& scene) : scene_(scene) {}

    Finding closest(const Ray& ray, const Answer& answer) const;
    /// The same where the double-precision ray's first hit is known.
    Finding closest(const Ray& ray, const Answer& answer, const ExactHit& first) const;
    ExactHit first_hit(const Ray& ray) const;
    /// Of a shadow ray, which ends at t_max and may be blocked by anything.
    Finding occluded(const Ray& ray, bool blocked) const;
    /// Of one that ends on a triangle which does not block it (`Accelerator::occluded`), or at a mere distance.
    Finding occluded(const Ray& ray, const Hit& end, bool blocked) const;

    /// The double-precision rays themselves; their tree is built when first asked for.
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

/// What the judge says of one kernel's answers: how many of `rays` were of a kind that counts against it.
struct Faults {
    std::int64_t rays = 0;
    std::int64_t edge = 0;  ///< Finding::kFault: what a watertight kernel never does
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

/// The rays on which two kernels differ, by what explains it. A hit of the same triangle at distances within
/// Judge::kTolerance is no difference.
struct Mismatches {
    std::int64_t rays = 0; ///< asked of both
    std::int64_t tie = 0, edge = 0, fault = 0, unexplained = 0; ///< by the worse of the two findings
    Faults ours, peer; ///< of the answers that differ: whose fault they are

    std::int64_t differ() const { return tie + edge + fault + unexplained; }
};

/// A set of rays and what is asked of each: the first hit, or, where there are ends, whether anything is in the way.
/// (The peer's shadow rays just end at their t_max.)
struct Questions {
    std::span<const Ray> rays;
    std::span<const Hit> ends; ///< one a shadow ray, or none

    bool closest() const { return ends.empty(); }
};
Mismatches compare_answers(const Judge& judge, const Questions& questions, std::span<const Answer> ours,
                           std::span<const Answer> peers, int threads);

/// Our answers by themselves: those to every `stride`-th ray.
Faults judge_answers(const Judge& judge, const Questions& questions, std::span<const Answer> answers,
                     std::size_t stride, int threads);

} // namespace duet::compare

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
    kEdge,  ///< within rounding of a triangle's edge or of the ray's ends: hit and miss are both right
    kWrong,
};

/// Judges answers for a scene of one mesh.
class Judge {
public:
    /// Places nearer than this part of their size (distance plus the largest coordinate of the ray's origin) count as
    /// one: some 80 roundings of single precision.
    static constexpr double kTolerance = 1e-5;

    explicit Judge(const Scene& scene) : scene_(scene) {}

    Finding closest(const Ray& ray, const Answer& answer) const;
    /// Of a shadow ray, which ends at t_max.
    Finding occluded(const Ray& ray, bool blocked) const;

    /// The double-precision rays themselves; their tree is built when first asked for.
    const ExactTracer& exact() const;

private:
    /// Distance between the line of the ray and the nearest edge of the triangle, seen along the ray.
    double edge_distance(const Rayd& ray, std::uint32_t triangle) const;
    /// Distance of the ray's origin from the triangle's plane.
    double plane_distance(const Rayd& ray, std::uint32_t triangle) const;
    bool nearly_occluded(const Rayd& ray) const;
    bool nearly_meets(const Rayd& ray, const Answer& answer) const;
    bool may_be_passed(const Rayd& ray, const ExactHit& hit) const;

    const Scene& scene_;
    mutable std::once_flag once_;
    mutable std::unique_ptr<const ExactTracer> exact_;
};

/// The rays on which two kernels differ, by what explains it. A hit of the same triangle at distances within
/// Judge::kTolerance is no difference.
struct Mismatches {
    std::int64_t rays = 0; ///< asked of both
    std::int64_t tie = 0, edge = 0, unexplained = 0;
    std::int64_t ours_wrong = 0, peer_wrong = 0; ///< whose answer of the unexplained is wrong: one's or both's

    std::int64_t differ() const { return tie + edge + unexplained; }
};

enum class Question { kClosest, kOccluded };
Mismatches compare_answers(const Judge& judge, Question question, std::span<const Ray> rays,
                           std::span<const Answer> ours, std::span<const Answer> peers, int threads);

/// Our answers by themselves: of every `stride`-th ray, how many are wrong.
struct Judged {
    std::int64_t rays = 0, wrong = 0;
};
Judged judge_answers(const Judge& judge, Question question, std::span<const Ray> rays, std::span<const Answer> answers,
                     std::size_t stride, int threads);

} // namespace duet::compare

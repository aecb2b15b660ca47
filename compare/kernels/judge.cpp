#include "compare/kernels/judge.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/vec/frame.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

constexpr double kGrazing = 1e-3; ///< cosine below which a ray is nearly parallel to a surface
constexpr int kDirections = 16;   ///< number of directions in which a ray is displaced to find what it just misses
constexpr int kAround = 32;       ///< number of directions in which a ray is displaced to find a way past what it hits

Rayd in_double(const Ray& ray) {
    return {Vec3d(ray.origin), Vec3d(ray.direction), static_cast<double>(ray.t_min), static_cast<double>(ray.t_max),
            static_cast<double>(ray.time)};
}

/// Returns the length below which distances are not distinguishable at t. Directions are of unit length.
double slack(const Rayd& ray, double t) { return Judge::kTolerance * (max_component(abs(ray.origin)) + std::abs(t)); }

double distance_to_segment(Vec3d a, Vec3d b) { // from the origin
    const Vec3d along = b - a;
    const double size = dot(along, along);
    const double s = size > 0 ? clamp(-dot(a, along) / size, 0.0, 1.0) : 0.0;
    return length(a + along * s);
}

/// Returns the corners of a triangle in world space, relative to the ray's origin.
std::array<Vec3d, 3> seen_from(const ExactTracer& exact, const Rayd& ray, std::uint32_t object,
                               std::uint32_t triangle) {
    const std::vector<Vec3d> p = exact.corners(object, triangle);
    DUET_CHECK_EQ(p.size(), std::size_t{3});
    return {p[0] - ray.origin, p[1] - ray.origin, p[2] - ray.origin};
}

/// Returns the distance between the ray's line and the nearest edge of the triangle, projected along the ray.
double edge_distance(const Rayd& ray, std::array<Vec3d, 3> p) {
    for (Vec3d& q : p) q = q - ray.direction * (dot(q, ray.direction) / dot(ray.direction, ray.direction));
    return min(min(distance_to_segment(p[0], p[1]), distance_to_segment(p[1], p[2])), distance_to_segment(p[2], p[0]));
}

/// Returns the distance between the ray's origin and the triangle's plane.
double plane_distance(const std::array<Vec3d, 3>& p) {
    const Vec3d n = cross(p[1] - p[0], p[2] - p[0]);
    return length(n) > 0 ? std::abs(dot(p[0], n)) / length(n) : 0;
}

/// Returns the i-th of `count` unit directions perpendicular to the ray.
Vec3d aside(const FrameT<double>& frame, int i, int count) {
    const double angle = 2 * kPiDouble * i / count;
    return frame.s * std::cos(angle) + frame.t * std::sin(angle);
}

} // namespace

const ExactTracer& Judge::exact() const {
    std::call_once(once_, [&] { exact_ = std::make_unique<const ExactTracer>(scene_, 0); });
    return *exact_;
}

// Returns whether the ray hits the triangle at the answer's distance, up to rounding.
bool Judge::nearly_meets(const Rayd& ray, const Answer& answer) const {
    const double t = answer.t;
    Rayd line = ray; // a ray may find the surface that it starts from on either side of its origin
    line.t_min = -slack(ray, 0) / kGrazing;
    const ExactHit hit = exact().intersect(line, answer.object, answer.triangle);
    if (hit.valid()) {
        const double cosine = exact().cosine(ray, answer.object, answer.triangle, hit.t);
        if (std::abs(hit.t - t) * cosine <= slack(ray, t)) return true;
    }
    const std::array<Vec3d, 3> corners = seen_from(exact(), ray, answer.object, answer.triangle);
    if (edge_distance(ray, corners) > slack(ray, t)) return false;
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const Vec3d& p : corners) {
        nearest = min(nearest, dot(p, ray.direction));
        farthest = max(farthest, dot(p, ray.direction));
    }
    return nearest - slack(ray, t) <= t && t <= farthest + slack(ray, t);
}

// Returns whether single precision may miss a double-precision hit because it is close to the ray's start or end.
bool Judge::at_an_end(const Rayd& ray, const ExactHit& hit) const {
    const double room = slack(ray, hit.t), cosine = exact().cosine(ray, hit.object, hit.primitive, hit.t);
    return (hit.t - ray.t_min) * cosine <= room || (ray.t_max - hit.t) * cosine <= room;
}

// Returns whether single precision may miss a double-precision hit because it is close to the triangle's edge.
bool Judge::at_an_edge(const Rayd& ray, const ExactHit& hit) const {
    return edge_distance(ray, seen_from(exact(), ray, hit.object, hit.primitive)) <= slack(ray, hit.t);
}

// Returns whether rays displaced by rounding errors to all sides are also blocked before `end`. If so, the edge
// that the ray hits is not a silhouette, and a watertight kernel does not let the ray through. Several
// displacement lengths are tried, because a long one may run into another surface. A single ray that passes
// disproves it.
bool Judge::goes_on_around(const Rayd& ray, const ExactHit& hit, double end) const {
    const double room = slack(ray, hit.t);
    const FrameT<double> frame = frame_from_normal(normalize(ray.direction));
    for (const double part : {1.0, 0.25, 0.0625})
        for (int i = 0; i < kAround; ++i) {
            Rayd beside = ray;
            beside.origin = ray.origin + aside(frame, i, kAround) * (room * part);
            beside.t_min = max(ray.t_min, hit.t - room / kGrazing);
            beside.t_max = std::isfinite(end) ? (hit.t + end) / 2 : end;
            if (!exact().nearest(beside).valid()) return false;
        }
    return true;
}

Finding Judge::closest(const Ray& ray, const Answer& answer) const {
    return closest(ray, answer, first_hit(ray));
}

ExactHit Judge::first_hit(const Ray& ray) const { return exact().nearest(in_double(ray)); }

Finding Judge::closest(const Ray& ray, const Answer& answer, const ExactHit& first) const {
    const Rayd r = in_double(ray);
    const auto is_answer = [&](const ExactHit& hit) {
        return hit.object == answer.object && hit.primitive == answer.triangle;
    };
    const double t = answer.t;
    if (answer.hit() && first.valid() && is_answer(first) && // the most common case
        std::abs(first.t - t) * exact().cosine(r, first.object, first.primitive, first.t) <= slack(r, t))
        return Finding::kRight;
    if (answer.hit() && !nearly_meets(r, answer)) return Finding::kWrong;
    Rayd rest = r;
    bool passed = false, slipped = false;
    const auto in_that_case = [&](Finding finding) {
        return slipped ? Finding::kFault : passed ? Finding::kEdge : finding;
    };
    // The answer is acceptable only if single precision may miss every surface in front of it.
    for (ExactHit hit = first;; hit = exact().nearest(rest)) {
        if (!hit.valid()) return in_that_case(answer.hit() ? Finding::kEdge : Finding::kRight);
        if (answer.hit()) {
            if (is_answer(hit)) return in_that_case(Finding::kRight);
            const double before = (t - hit.t) * exact().cosine(r, hit.object, hit.primitive, hit.t);
            if (before < -slack(r, hit.t)) return in_that_case(Finding::kEdge);
            if (before <= slack(r, hit.t)) return in_that_case(Finding::kTie);
        }
        if (!at_an_end(r, hit)) {
            if (!at_an_edge(r, hit)) return Finding::kWrong;
            slipped = slipped || goes_on_around(r, hit, answer.hit() ? t : r.t_max);
        }
        passed = true;
        rest.t_min = hit.t;
    }
}

Finding Judge::occluded(const Ray& ray, bool blocked) const {
    Hit end;
    end.t = ray.t_max;
    return occluded(ray, end, blocked);
}

Finding Judge::occluded(const Ray& ray, const Hit& end, bool blocked) const {
    Rayd r = in_double(ray);
    r.t_max = end.t;
    Rayd rest = r;
    bool passed = false, slipped = false;
    while (true) {
        const ExactHit hit = exact().nearest(rest);
        if (!hit.valid()) break;
        rest.t_min = hit.t;
        if (hit.same_as(end)) continue;
        if (blocked) return Finding::kRight;
        if (!at_an_end(r, hit)) {
            if (!at_an_edge(r, hit)) return Finding::kWrong;
            slipped = slipped || goes_on_around(r, hit, r.t_max);
        }
        passed = true;
    }
    if (!blocked) return slipped ? Finding::kFault : passed ? Finding::kEdge : Finding::kRight;
    return nearly_occluded(r, end) ? Finding::kEdge : Finding::kWrong;
}

// Returns whether there is something just beside an unoccluded ray or just beyond its end. Displaced rays start
// behind the surface that the ray itself starts on; that surface does not count as an occluder.
bool Judge::nearly_occluded(const Rayd& ray, const Hit& end) const {
    const double reach = std::isfinite(ray.t_max) ? ray.t_max : length(scene_.bounds.diagonal());
    const double room = slack(ray, reach);
    const FrameT<double> frame = frame_from_normal(normalize(ray.direction));
    for (int i = 0; i <= kDirections; ++i) {
        Rayd near = ray;
        if (i < kDirections) near.origin = ray.origin + aside(frame, i, kDirections) * room;
        near.t_max = ray.t_max + room;
        for (ExactHit hit = exact().nearest(near); hit.valid(); hit = exact().nearest(near)) {
            const bool blocks = !hit.same_as(end) &&
                                plane_distance(seen_from(exact(), ray, hit.object, hit.primitive)) > slack(ray, 0);
            if (blocks) return true;
            near.t_min = hit.t;
        }
    }
    return false;
}

namespace {

Finding judged(const Judge& judge, const Questions& questions, std::size_t i, const Answer& answer) {
    const Ray& ray = questions.rays[i];
    return questions.closest() ? judge.closest(ray, answer) : judge.occluded(ray, questions.ends[i], answer.hit());
}

} // namespace

Faults judge_answers(const Judge& judge, const Questions& questions, std::span<const Answer> answers,
                     std::size_t stride, int threads) {
    DUET_CHECK_EQ(questions.rays.size(), answers.size());
    std::vector<Finding> findings((answers.size() + stride - 1) / stride);
    parallel_for(findings.size(), threads,
                 [&](std::size_t k) { findings[k] = judged(judge, questions, k * stride, answers[k * stride]); });
    Faults faults;
    for (const Finding finding : findings) faults.count(finding);
    return faults;
}

Mismatches compare_answers(const Judge& judge, const Questions& questions, std::span<const Answer> ours,
                           std::span<const Answer> peers, int threads) {
    const std::span<const Ray> rays = questions.rays;
    DUET_CHECK_EQ(rays.size(), ours.size());
    DUET_CHECK_EQ(rays.size(), peers.size());
    const auto equal = [&](std::size_t i) {
        if (ours[i].triangle != peers[i].triangle || ours[i].object != peers[i].object) return false;
        if (!ours[i].hit() || !questions.closest()) return true;
        const double t = ours[i].t;
        return std::abs(t - static_cast<double>(peers[i].t)) <= slack(in_double(rays[i]), t);
    };
    std::vector<std::size_t> different;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!equal(i)) different.push_back(i);

    std::vector<std::pair<Finding, Finding>> findings(different.size());
    parallel_for(different.size(), threads, [&](std::size_t k) {
        const std::size_t i = different[k];
        findings[k].first = judged(judge, questions, i, ours[i]);
        findings[k].second = questions.closest() ? judge.closest(rays[i], peers[i])
                                                 : judge.occluded(rays[i], peers[i].hit()); // as queried
    });
    Mismatches result;
    result.rays = std::ssize(rays);
    for (const auto& [a, b] : findings) {
        result.ours.count(a);
        result.peer.count(b);
        switch (std::max(a, b)) {
        case Finding::kWrong:
            ++result.unexplained;
            break;
        case Finding::kFault:
            ++result.fault;
            break;
        case Finding::kEdge:
            ++result.edge;
            break;
        case Finding::kTie:
        case Finding::kRight:
            ++result.tie;
        }
    }
    return result;
}

} // namespace duet::compare

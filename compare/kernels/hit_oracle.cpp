#include "compare/kernels/hit_oracle.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/vec/frame.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

constexpr double kGrazing = 1e-3; ///< cosine below which a ray is nearly parallel to a surface
constexpr int kDirections = 16;   ///< number of directions in which a ray is displaced to find what it just misses
constexpr int kSurroundingRays =
    32; ///< number of directions in which a ray is displaced to get past the surface that it hits

Rayd in_double(const Ray& ray) {
    return {Vec3d(ray.origin), Vec3d(ray.direction), static_cast<double>(ray.t_min), static_cast<double>(ray.t_max),
            static_cast<double>(ray.time)};
}

/// Returns the length below which distances are not distinguishable at t. Directions are of unit length.
double distance_tolerance(const Rayd& ray, double t) {
    return HitOracle::kTolerance * (max_component(abs(ray.origin)) + std::abs(t));
}

double distance_to_segment(Vec3d a, Vec3d b) { // from the origin to the segment
    const Vec3d along = b - a;
    const double size = dot(along, along);
    const double s = size > 0 ? clamp(-dot(a, along) / size, 0.0, 1.0) : 0.0;
    return length(a + along * s);
}

/// Returns the corners of a triangle in world space, relative to the ray's origin.
std::array<Vec3d, 3> relative_corners(const ReferenceTracer& exact, const Rayd& ray, std::uint32_t object,
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
Vec3d perpendicular_direction(const FrameT<double>& frame, int i, int count) {
    const double angle = 2 * kPiDouble * i / count;
    return frame.s * std::cos(angle) + frame.t * std::sin(angle);
}

} // namespace

const ReferenceTracer& HitOracle::exact() const {
    std::call_once(once_, [&] { exact_ = std::make_unique<const ReferenceTracer>(scene_, 0); });
    return *exact_;
}

// Returns whether the ray hits the triangle at the result's distance, up to rounding.
bool HitOracle::hits_within_rounding(const Rayd& ray, const RayResult& ray_result) const {
    const double t = ray_result.t;
    Rayd line = ray; // a ray may find the surface that it starts from on either side of its origin
    line.t_min = -distance_tolerance(ray, 0) / kGrazing;
    const ReferenceHit hit = exact().intersect(line, ray_result.object, ray_result.triangle);
    if (hit.valid()) {
        const double cosine = exact().cosine(ray, ray_result.object, ray_result.triangle, hit.t);
        if (std::abs(hit.t - t) * cosine <= distance_tolerance(ray, t)) return true;
    }
    const std::array<Vec3d, 3> corners = relative_corners(exact(), ray, ray_result.object, ray_result.triangle);
    if (edge_distance(ray, corners) > distance_tolerance(ray, t)) return false;
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const Vec3d& p : corners) {
        nearest = min(nearest, dot(p, ray.direction));
        farthest = max(farthest, dot(p, ray.direction));
    }
    return nearest - distance_tolerance(ray, t) <= t && t <= farthest + distance_tolerance(ray, t);
}

// Returns whether single precision may miss a double-precision hit because it is close to the ray's start or end.
bool HitOracle::is_near_ray_end(const Rayd& ray, const ReferenceHit& hit) const {
    const double tolerance = distance_tolerance(ray, hit.t),
                 cosine = exact().cosine(ray, hit.object, hit.primitive, hit.t);
    return (hit.t - ray.t_min) * cosine <= tolerance || (ray.t_max - hit.t) * cosine <= tolerance;
}

// Returns whether single precision may miss a double-precision hit because it is close to the triangle's edge.
bool HitOracle::is_near_edge(const Rayd& ray, const ReferenceHit& hit) const {
    return edge_distance(ray, relative_corners(exact(), ray, hit.object, hit.primitive)) <=
           distance_tolerance(ray, hit.t);
}

// Returns whether rays that are displaced to all sides by the rounding error are also blocked before `end`. If so, the
// edge that the ray hits is not a silhouette, and a watertight kernel does not let the ray through. Several
// displacement lengths are tried, because a long one may run into another surface. A single displaced ray that is not
// blocked makes the result false.
bool HitOracle::surface_continues_around(const Rayd& ray, const ReferenceHit& hit, double end) const {
    const double tolerance = distance_tolerance(ray, hit.t);
    const FrameT<double> frame = frame_from_normal(normalize(ray.direction));
    for (const double part : {1.0, 0.25, 0.0625})
        for (int i = 0; i < kSurroundingRays; ++i) {
            Rayd displaced = ray;
            displaced.origin = ray.origin + perpendicular_direction(frame, i, kSurroundingRays) * (tolerance * part);
            displaced.t_min = max(ray.t_min, hit.t - tolerance / kGrazing);
            displaced.t_max = std::isfinite(end) ? (hit.t + end) / 2 : end;
            if (!exact().nearest(displaced).valid()) return false;
        }
    return true;
}

AnswerVerdict HitOracle::closest(const Ray& ray, const RayResult& ray_result) const {
    return closest(ray, ray_result, first_hit(ray));
}

ReferenceHit HitOracle::first_hit(const Ray& ray) const { return exact().nearest(in_double(ray)); }

AnswerVerdict HitOracle::closest(const Ray& ray, const RayResult& ray_result, const ReferenceHit& first) const {
    const Rayd r = in_double(ray);
    const auto is_answer = [&](const ReferenceHit& hit) {
        return hit.object == ray_result.object && hit.primitive == ray_result.triangle;
    };
    const double t = ray_result.t;
    if (ray_result.hit() && first.valid() && is_answer(first) && // the most common case
        std::abs(first.t - t) * exact().cosine(r, first.object, first.primitive, first.t) <= distance_tolerance(r, t))
        return AnswerVerdict::kCorrect;
    if (ray_result.hit() && !hits_within_rounding(r, ray_result)) return AnswerVerdict::kWrong;
    Rayd rest = r;
    bool skipped_surface = false, leaked = false;
    const auto after_skipped_surfaces = [&](AnswerVerdict finding) {
        return leaked ? AnswerVerdict::kEdgeLeak : skipped_surface ? AnswerVerdict::kEdge : finding;
    };
    // The result is acceptable only if single precision may miss every surface in front of it.
    for (ReferenceHit hit = first;; hit = exact().nearest(rest)) {
        if (!hit.valid())
            return after_skipped_surfaces(ray_result.hit() ? AnswerVerdict::kEdge : AnswerVerdict::kCorrect);
        if (ray_result.hit()) {
            if (is_answer(hit)) return after_skipped_surfaces(AnswerVerdict::kCorrect);
            const double before = (t - hit.t) * exact().cosine(r, hit.object, hit.primitive, hit.t);
            if (before < -distance_tolerance(r, hit.t)) return after_skipped_surfaces(AnswerVerdict::kEdge);
            if (before <= distance_tolerance(r, hit.t)) return after_skipped_surfaces(AnswerVerdict::kTie);
        }
        if (!is_near_ray_end(r, hit)) {
            if (!is_near_edge(r, hit)) return AnswerVerdict::kWrong;
            leaked = leaked || surface_continues_around(r, hit, ray_result.hit() ? t : r.t_max);
        }
        skipped_surface = true;
        rest.t_min = hit.t;
    }
}

AnswerVerdict HitOracle::occluded(const Ray& ray, bool blocked) const {
    Hit end;
    end.t = ray.t_max;
    return occluded(ray, end, blocked);
}

AnswerVerdict HitOracle::occluded(const Ray& ray, const Hit& end, bool blocked) const {
    Rayd r = in_double(ray);
    r.t_max = end.t;
    Rayd rest = r;
    bool skipped_surface = false, leaked = false;
    while (true) {
        const ReferenceHit hit = exact().nearest(rest);
        if (!hit.valid()) break;
        rest.t_min = hit.t;
        if (hit.same_as(end)) continue;
        if (blocked) return AnswerVerdict::kCorrect;
        if (!is_near_ray_end(r, hit)) {
            if (!is_near_edge(r, hit)) return AnswerVerdict::kWrong;
            leaked = leaked || surface_continues_around(r, hit, r.t_max);
        }
        skipped_surface = true;
    }
    if (!blocked)
        return leaked ? AnswerVerdict::kEdgeLeak : skipped_surface ? AnswerVerdict::kEdge : AnswerVerdict::kCorrect;
    return is_nearly_occluded(r, end) ? AnswerVerdict::kEdge : AnswerVerdict::kWrong;
}

// Returns whether a surface lies just beside an unoccluded ray or just beyond its end. Displaced rays start behind the
// surface that the ray itself starts on; that surface does not count as an occluder.
bool HitOracle::is_nearly_occluded(const Rayd& ray, const Hit& end) const {
    const double reach = std::isfinite(ray.t_max) ? ray.t_max : length(scene_.bounds.diagonal());
    const double tolerance = distance_tolerance(ray, reach);
    const FrameT<double> frame = frame_from_normal(normalize(ray.direction));
    for (int i = 0; i <= kDirections; ++i) {
        Rayd near = ray;
        if (i < kDirections) near.origin = ray.origin + perpendicular_direction(frame, i, kDirections) * tolerance;
        near.t_max = ray.t_max + tolerance;
        for (ReferenceHit hit = exact().nearest(near); hit.valid(); hit = exact().nearest(near)) {
            const bool blocks =
                !hit.same_as(end) &&
                plane_distance(relative_corners(exact(), ray, hit.object, hit.primitive)) > distance_tolerance(ray, 0);
            if (blocks) return true;
            near.t_min = hit.t;
        }
    }
    return false;
}

namespace {

AnswerVerdict verdict_of(const HitOracle& oracle, const RayQueries& ray_queries, std::size_t i,
                         const RayResult& ray_result) {
    const Ray& ray = ray_queries.rays[i];
    return ray_queries.closest() ? oracle.closest(ray, ray_result)
                                 : oracle.occluded(ray, ray_queries.ends[i], ray_result.hit());
}

} // namespace

KernelErrors check_answers(const HitOracle& oracle, const RayQueries& ray_queries,
                           std::span<const RayResult> ray_results, std::size_t stride, int threads) {
    DUET_CHECK_EQ(ray_queries.rays.size(), ray_results.size());
    std::vector<AnswerVerdict> findings((ray_results.size() + stride - 1) / stride);
    parallel_for(findings.size(), threads, [&](std::size_t k) {
        findings[k] = verdict_of(oracle, ray_queries, k * stride, ray_results[k * stride]);
    });
    KernelErrors faults;
    for (const AnswerVerdict finding : findings) faults.count(finding);
    return faults;
}

Mismatches compare_results(const HitOracle& oracle, const RayQueries& ray_queries, std::span<const RayResult> ours,
                           std::span<const RayResult> peers, int threads) {
    const std::span<const Ray> rays = ray_queries.rays;
    DUET_CHECK_EQ(rays.size(), ours.size());
    DUET_CHECK_EQ(rays.size(), peers.size());
    const auto equal = [&](std::size_t i) {
        if (ours[i].triangle != peers[i].triangle || ours[i].object != peers[i].object) return false;
        if (!ours[i].hit() || !ray_queries.closest()) return true;
        const double t = ours[i].t;
        return std::abs(t - static_cast<double>(peers[i].t)) <= distance_tolerance(in_double(rays[i]), t);
    };
    std::vector<std::size_t> different;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!equal(i)) different.push_back(i);

    std::vector<std::pair<AnswerVerdict, AnswerVerdict>> findings(different.size());
    parallel_for(different.size(), threads, [&](std::size_t k) {
        const std::size_t i = different[k];
        findings[k].first = verdict_of(oracle, ray_queries, i, ours[i]);
        findings[k].second = ray_queries.closest() ? oracle.closest(rays[i], peers[i])
                                                   : oracle.occluded(rays[i], peers[i].hit()); // the ray ends at t_max
    });
    Mismatches result;
    result.rays = std::ssize(rays);
    for (const auto& [a, b] : findings) {
        result.ours.count(a);
        result.peer.count(b);
        switch (std::max(a, b)) {
        case AnswerVerdict::kWrong:
            ++result.unexplained;
            break;
        case AnswerVerdict::kEdgeLeak:
            ++result.fault;
            break;
        case AnswerVerdict::kEdge:
            ++result.edge;
            break;
        case AnswerVerdict::kTie:
        case AnswerVerdict::kCorrect:
            ++result.tie;
        }
    }
    return result;
}

} // namespace duet::compare

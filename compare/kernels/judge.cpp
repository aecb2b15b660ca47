#include "compare/kernels/judge.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/vec/frame.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

constexpr double kGrazing = 1e-3; ///< the cosine below which a ray runs in a surface rather than through it
constexpr int kDirections = 16;   ///< in which a ray is displaced to look for what it just misses

Rayd in_double(const Ray& ray) {
    return {Vec3d(ray.origin), Vec3d(ray.direction), static_cast<double>(ray.t_min), static_cast<double>(ray.t_max),
            static_cast<double>(ray.time)};
}

/// Lengths below this cannot be told from none, at the distance t (directions are of unit length).
double slack(const Rayd& ray, double t) { return Judge::kTolerance * (max_component(abs(ray.origin)) + std::abs(t)); }

double distance_to_segment(Vec3d a, Vec3d b) { // from the origin
    const Vec3d along = b - a;
    const double size = dot(along, along);
    const double s = size > 0 ? clamp(-dot(a, along) / size, 0.0, 1.0) : 0.0;
    return length(a + along * s);
}

std::array<Vec3d, 3> triangle_seen_from(const Scene& scene, const Rayd& ray, std::uint32_t triangle) {
    const Mesh& mesh = std::get<Mesh>(scene.shapes.front());
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {Vec3d(mesh.positions[a]) - ray.origin, Vec3d(mesh.positions[b]) - ray.origin,
            Vec3d(mesh.positions[c]) - ray.origin};
}

} // namespace

const ExactTracer& Judge::exact() const {
    std::call_once(once_, [&] { exact_ = std::make_unique<const ExactTracer>(scene_, 0); });
    return *exact_;
}

double Judge::edge_distance(const Rayd& ray, std::uint32_t triangle) const {
    std::array<Vec3d, 3> p = triangle_seen_from(scene_, ray, triangle);
    for (Vec3d& q : p) q = q - ray.direction * (dot(q, ray.direction) / dot(ray.direction, ray.direction));
    return min(min(distance_to_segment(p[0], p[1]), distance_to_segment(p[1], p[2])), distance_to_segment(p[2], p[0]));
}

double Judge::plane_distance(const Rayd& ray, std::uint32_t triangle) const {
    const auto [a, b, c] = triangle_seen_from(scene_, ray, triangle);
    const Vec3d n = cross(b - a, c - a);
    return length(n) > 0 ? std::abs(dot(a, n)) / length(n) : 0;
}

// Whether the triangle is where the answer says, on the ray or as near as rounding allows.
bool Judge::nearly_meets(const Rayd& ray, const Answer& answer) const {
    const double t = answer.t;
    Rayd line = ray; // the surface that a ray starts from may be found on either side of its start
    line.t_min = -slack(ray, 0) / kGrazing;
    const ExactHit hit = exact().intersect(line, 0, answer.triangle);
    if (hit.valid()) {
        const double cosine = exact().cosine(ray, 0, answer.triangle, hit.t);
        if (std::abs(hit.t - t) * cosine <= slack(ray, t)) return true;
    }
    if (edge_distance(ray, answer.triangle) > slack(ray, t)) return false;
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (const Vec3d& p : triangle_seen_from(scene_, ray, answer.triangle)) {
        nearest = min(nearest, dot(p, ray.direction));
        farthest = max(farthest, dot(p, ray.direction));
    }
    return nearest - slack(ray, t) <= t && t <= farthest + slack(ray, t);
}

// Whether single precision may miss what double precision hits: at the triangle's edge, or at the ray's ends.
bool Judge::may_be_passed(const Rayd& ray, const ExactHit& hit) const {
    const double room = slack(ray, hit.t), cosine = exact().cosine(ray, hit.object, hit.primitive, hit.t);
    return edge_distance(ray, hit.primitive) <= room || (hit.t - ray.t_min) * cosine <= room ||
           (ray.t_max - hit.t) * cosine <= room;
}

Finding Judge::closest(const Ray& ray, const Answer& answer) const {
    const Rayd r = in_double(ray);
    if (answer.hit() && !nearly_meets(r, answer)) return Finding::kWrong;
    Rayd rest = r;
    bool passed = false;
    while (true) { // whatever lies before the answer must be possible to miss
        const ExactHit hit = exact().nearest(rest);
        if (!hit.valid()) return passed || answer.hit() ? Finding::kEdge : Finding::kRight;
        if (answer.hit()) {
            if (hit.primitive == answer.triangle) return passed ? Finding::kEdge : Finding::kRight;
            const double before = (static_cast<double>(answer.t) - hit.t) * exact().cosine(r, 0, hit.primitive, hit.t);
            if (before < -slack(r, hit.t)) return Finding::kEdge;
            if (before <= slack(r, hit.t)) return passed ? Finding::kEdge : Finding::kTie;
        }
        if (!may_be_passed(r, hit)) return Finding::kWrong;
        passed = true;
        rest.t_min = hit.t;
    }
}

Finding Judge::occluded(const Ray& ray, bool blocked) const {
    const Rayd r = in_double(ray);
    Rayd rest = r;
    bool passed = false;
    while (true) {
        const ExactHit hit = exact().nearest(rest);
        if (!hit.valid()) break;
        if (blocked) return Finding::kRight;
        if (!may_be_passed(r, hit)) return Finding::kWrong;
        passed = true;
        rest.t_min = hit.t;
    }
    if (!blocked) return passed ? Finding::kEdge : Finding::kRight;
    return nearly_occluded(r) ? Finding::kEdge : Finding::kWrong;
}

// Nothing is in the way: is there something just beside it, or just beyond the end? A ray beside it starts behind the
// surface that the ray itself starts on, which is no reason to be blocked.
bool Judge::nearly_occluded(const Rayd& ray) const {
    const double reach = std::isfinite(ray.t_max) ? ray.t_max : length(scene_.bounds.diagonal());
    const double room = slack(ray, reach);
    const FrameT<double> frame = frame_from_normal(normalize(ray.direction));
    for (int i = 0; i <= kDirections; ++i) {
        const double angle = 2 * kPiDouble * i / kDirections;
        const Vec3d aside = i == kDirections ? Vec3d() : frame.s * std::cos(angle) + frame.t * std::sin(angle);
        Rayd near = ray;
        near.origin = ray.origin + aside * room;
        near.t_max = ray.t_max + room;
        for (ExactHit hit = exact().nearest(near); hit.valid(); hit = exact().nearest(near)) {
            if (plane_distance(ray, hit.primitive) > slack(ray, 0)) return true;
            near.t_min = hit.t;
        }
    }
    return false;
}

namespace {

Finding judged(const Judge& judge, Question question, const Ray& ray, const Answer& answer) {
    return question == Question::kClosest ? judge.closest(ray, answer) : judge.occluded(ray, answer.hit());
}

} // namespace

Judged judge_answers(const Judge& judge, Question question, std::span<const Ray> rays, std::span<const Answer> answers,
                     std::size_t stride, int threads) {
    DUET_CHECK_EQ(rays.size(), answers.size());
    std::vector<char> wrong((rays.size() + stride - 1) / stride);
    parallel_for(wrong.size(), threads, [&](std::size_t k) {
        wrong[k] = judged(judge, question, rays[k * stride], answers[k * stride]) == Finding::kWrong;
    });
    return {std::ssize(wrong), std::ranges::count(wrong, 1)};
}

Mismatches compare_answers(const Judge& judge, Question question, std::span<const Ray> rays,
                           std::span<const Answer> ours, std::span<const Answer> peers, int threads) {
    DUET_CHECK_EQ(rays.size(), ours.size());
    DUET_CHECK_EQ(rays.size(), peers.size());
    const auto equal = [&](std::size_t i) {
        if (ours[i].triangle != peers[i].triangle) return false;
        if (!ours[i].hit() || question == Question::kOccluded) return true;
        const double t = ours[i].t;
        return std::abs(t - static_cast<double>(peers[i].t)) <= slack(in_double(rays[i]), t);
    };
    std::vector<std::size_t> different;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!equal(i)) different.push_back(i);

    std::vector<std::pair<Finding, Finding>> findings(different.size());
    parallel_for(different.size(), threads, [&](std::size_t k) {
        const std::size_t i = different[k];
        findings[k] = {judged(judge, question, rays[i], ours[i]), judged(judge, question, rays[i], peers[i])};
    });
    Mismatches result;
    result.rays = static_cast<std::int64_t>(rays.size());
    for (const auto& [a, b] : findings) {
        result.ours_wrong += a == Finding::kWrong;
        result.peer_wrong += b == Finding::kWrong;
        if (a == Finding::kWrong || b == Finding::kWrong)
            ++result.unexplained;
        else if (a == Finding::kEdge || b == Finding::kEdge)
            ++result.edge;
        else
            ++result.tie;
    }
    return result;
}

} // namespace duet::compare

#include "raster/screen_space/horizon_search.h"

#include "raster/geometry/lane_math.h"
#include "raster/geometry/sample_positions.h"

#include "common/vec/frame.h"

#include <array>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

/// A height above the plane counts as rounding error if it is below this fraction of the distance between two points.
constexpr float kSlack = 1e-3f;
/// Directions to points nearer than this fraction of the distance from the eye are dominated by rounding.
constexpr float kClosest = 3e-4f;
constexpr float kFadeFrom = 0.75f;    ///< fraction of the radius at which horizons begin to fade
constexpr float kLeastCosine = 0.02f; ///< least cosine between normal and viewer; interpolated normals may face away
constexpr int kSteps = 10;            ///< depth samples on each side of a pixel

/// Holds the integrals over the open arc from the viewer's direction v, θ = 0, to a horizon, in the plane of v and t.
/// The projected normal is at the angle γ. `all` is ∫ cos(θ − γ) sin θ dθ; `along_v` and `along_t` have the additional
/// factors cos θ and sin θ.
struct Arc {
    Floats all, along_v, along_t;
};
Arc arc(const Floats& angle, const Floats& cosine, const Floats& sine, const Floats& cos_gamma,
        const Floats& sin_gamma) {
    const Floats third(1.0f / 3), cube = sine * sine * sine * third;
    return {Floats(0.5f) * (cos_gamma * sine * sine + sin_gamma * (angle - sine * cosine)),
            cos_gamma * (third - cosine * cosine * cosine * third) + sin_gamma * cube,
            cos_gamma * cube + sin_gamma * (Floats(2.0f / 3) - cosine + cosine * cosine * cosine * third)};
}

/// Holds the horizon on one side of each point, and the light of the surfaces that make it.
struct Horizon {
    Floats cosine; ///< to the viewer
    Vec3s light{Floats(0.0f), Floats(0.0f), Floats(0.0f)}; ///< sum over surfaces of light times gain
    Floats gain = Floats(0.0f); ///< sum of the amounts by which surfaces raise the cosine
};

/// Searches for horizons. A horizon is the greatest cosine to the viewer of the surfaces along a line from each point.
class HorizonSearch {
public:
    /// `depth` holds the reversed depths of every second pixel of every second row. Without `occluders` (null), which
    /// are the same pixels, no light is searched for.
    HorizonSearch(const GBuffer& gbuffer, const PlaneFloat& depth, const Occluders* occluders,
                  const Vec3s& p, const Vec3s& n, const Vec3s& to_viewer, float radius)
        : gbuffer_(gbuffer), depth_(depth), occluders_(occluders), p_(p), n_(n), to_viewer_(to_viewer),
          home_(gbuffer.projection.homogeneous(p)), radius_(radius), closest_(Floats(kClosest * kClosest) * dot(p, p)) {
        const Floats over_w = Floats(1.0f) / home_[3];
        x_ = home_[0] * over_w, y_ = home_[1] * over_w;
    }

    /// Returns the horizon toward the unit vector t, which is perpendicular to the view; at least `lowest`.
    Horizon operator()(const Vec3s& t, const Floats& lowest, const Floats& jitter) const {
        const std::array<Floats, 4> change = gbuffer_.projection.homogeneous_change(t);
        const Floats over_w = Floats(1.0f) / home_[3];
        Floats step_x = (change[0] - x_ * change[3]) * over_w, step_y = (change[1] - y_ * change[3]) * over_w;
        const Floats speed = xsimd::sqrt(step_x * step_x + step_y * step_y),
                     per_pixel = Floats(1.0f) / max(speed, Floats(1e-20f));
        step_x *= per_pixel, step_y *= per_pixel;
        const Floats width(static_cast<float>(gbuffer_.width())), height(static_cast<float>(gbuffer_.height()));
        const Floats pixels =
            min(speed * Floats(radius_), min(to_edge(x_, step_x, width), to_edge(y_, step_y, height)));
        Horizon result{lowest};
        for (int i = 0; i < kSteps; ++i) {
            const Floats s = (Floats(static_cast<float>(i)) + jitter) * Floats(1.0f / kSteps);
            // The nearest other pixel is 2 away. Steps are denser near the point, where occluders block most.
            const Floats reach = Floats(2.0f) + s * s * pixels;
            raise(result, x_ + step_x * reach, y_ + step_y * reach, lowest);
        }
        return result;
    }

private:
    /// Raises the horizon to the surface at a position in pixels if that counts as an occluder.
    void raise(Horizon& horizon, const Floats& x, const Floats& y, const Floats& lowest) const {
        const Floats none(0.0f), half(0.5f), two(2.0f);
        const auto inside = [&](const Floats& at, int size) {
            return (at >= -half) & (at <= Floats(static_cast<float>(size)) - half);
        };
        const auto nearest = [&](const Floats& at, int size) { // of every second pixel
            return clamp(xsimd::floor(at * half + half), none, Floats(static_cast<float>(size - 1)));
        };
        const Floats column = nearest(x, depth_.width()), row = nearest(y, depth_.height());
        const Ints index = truncated(row) * Ints(depth_.stride()) + truncated(column);
        const Floats depth = gather(depth_.row(0), index);
        const Vec3s to = gbuffer_.projection.point(Floats(column * two), Floats(row * two), depth) - p_;
        const Floats squared = dot(to, to), over = inverse_sqrt(squared), distance = squared * over;
        const Mask counts = inside(x, gbuffer_.width()) & inside(y, gbuffer_.height()) & (depth > none) &
                            (squared > closest_) & (distance < Floats(radius_)) &
                            (dot(n_, to) >= Floats(kSlack) * distance);
        const Floats fade = max(distance * Floats(1 / (radius_ * (1 - kFadeFrom))) -
                                    Floats(kFadeFrom / (1 - kFadeFrom)), none);
        const Floats cosine = xsimd::select(counts, lerp(dot(to, to_viewer_) * over, lowest, fade), lowest);
        const Floats gain = max(cosine - horizon.cosine, none);
        horizon.cosine = max(horizon.cosine, cosine);
        if (occluders_ == nullptr || !xsimd::any(gain > none)) return;
        const auto of = [&](const PlaneFloat& plane) { return gather(plane.row(0), index); };
        const auto read = [&](const Planes3& planes) { return Vec3s{of(planes.x), of(planes.y), of(planes.z)}; };
        const Mask faces = dot(read(occluders_->normals), to) < none; // the point
        horizon.light += select(faces, read(occluders_->front), read(occluders_->back)) * gain;
        horizon.gain += gain;
    }
    /// Returns the distance in pixels to the image's edge in a unit direction.
    static Floats to_edge(const Floats& at, const Floats& step, const Floats& size) {
        const Floats end = xsimd::select(step > Floats(0.0f), size, Floats(0.0f));
        return max(xsimd::select(step == Floats(0.0f), Floats(1e9f), (end - at) / step), Floats(0.0f));
    }

    const GBuffer& gbuffer_;
    const PlaneFloat& depth_;
    const Occluders* occluders_;
    const Vec3s &p_, &n_, &to_viewer_;
    std::array<Floats, 4> home_;
    Floats x_, y_;
    float radius_;
    Floats closest_;
};

/// Holds the direction and the step jitter of each pixel of a block, in [0, 1). The sixteen directions are the odd
/// multiples of 1/32, ordered so that neighbors differ, and the jitters are spread likewise.
struct Pattern {
    Floats turn, jitter;
};
Pattern pattern_of(int x, int y) {
    PacketOf<float> turn, jitter;
    for (int i = 0; i < static_cast<int>(Floats::size); ++i) {
        const auto fraction = [](int column, int row) {
            return (static_cast<float>(dither_rank(column, row)) + 0.5f) / 16;
        };
        const int other = (y % kDitherSide * kDitherSide + (x + i) % kDitherSide) * 5 + 3;
        turn[static_cast<std::size_t>(i)] = fraction(x + i, y);
        jitter[static_cast<std::size_t>(i)] = fraction(other, other / kDitherSide);
    }
    return {load(turn, 0), load(jitter, 0)};
}

} // namespace

OccludedLine search_line(const GBuffer& gbuffer, const PlaneFloat& depth, const Occluders* occluders,
                         const Vec3s& p, const Vec3s& normal, float radius, int x, int y) {
    const Pattern pattern = pattern_of(x, y);
    const Floats one(1.0f), none(0.0f);
    const Vec3s v = gbuffer.projection.to_viewer(p);
    const Vec3s n = unit_of(normal + v * max(Floats(kLeastCosine) - dot(normal, v), none));
    // Heights are measured above the surface itself. Above the plane of n, points of the surface would have some, too.
    const HorizonSearch search(gbuffer, depth, occluders, p, normal, v, radius);
    const FrameT<Floats> frame = frame_from_normal(v);
    const auto [sine, cosine] = xsimd::sincos(pattern.turn * Floats(kPi));
    const Vec3s t = frame.s * cosine + frame.t * sine, across = cross(v, t);
    const Vec3s in_plane = n - across * dot(n, across); // the normal projected to the plane of v and t
    const Floats size = xsimd::sqrt(dot(in_plane, in_plane)), over = one / max(size, Floats(1e-6f));
    const Floats cos_gamma = min(dot(in_plane, v) * over, one), sin_gamma = dot(in_plane, t) * over;
    const Floats turned = arc_cosine(cos_gamma), gamma = xsimd::select(sin_gamma < none, -turned, turned);
    const Floats all = size * (cos_gamma + gamma * sin_gamma);
    Floats lost = none;
    Vec3s hidden{none, none, none};
    for (const float side : {1.0f, -1.0f}) {
        const Floats s = Floats(side) * sin_gamma, lowest = -s; // the tangent plane's horizon, π/2 from the normal
        const Horizon horizon = search(t * Floats(side), lowest, pattern.jitter);
        const Floats highest = horizon.cosine;
        const Arc open = arc(Floats(kPi / 2) + Floats(side) * gamma, lowest, cos_gamma, cos_gamma, s);
        const Arc seen = arc(arc_cosine(highest), highest, xsimd::sqrt(max(one - highest * highest, none)), cos_gamma,
                             s);
        const auto less = [&](const Floats& whole, const Floats& rest) { // exactly 0 if nothing is hidden
            return xsimd::select(highest > lowest, size * (whole - rest), none);
        };
        const Floats part = max(less(open.all, seen.all), none);
        lost += part;
        if (occluders != nullptr)
            hidden += horizon.light * (part / max(horizon.gain, Floats(1e-20f)));
        else
            hidden += v * less(open.along_v, seen.along_v) + t * (Floats(side) * less(open.along_t, seen.along_t));
    }
    return {all, lost, hidden};
}

} // namespace duet::raster

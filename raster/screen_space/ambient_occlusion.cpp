#include "raster/screen_space/ambient_occlusion.h"

#include "common/sampling/sobol.h"
#include "common/sampling/warp.h"
#include "common/vec/frame.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// A height above the plane below this fraction of the distance between two points is rounding error.
constexpr float kSlack = 1e-3f;
/// The direction to a point nearer than this fraction of the distance from the eye is dominated by rounding.
constexpr float kClosest = 3e-4f;
constexpr float kFadeFrom = 0.75f; ///< fraction of the radius at which horizons begin to fade
constexpr float kMinCosine = 0.02f; ///< between normal and viewer; interpolated shading normals may face away
constexpr int kPoints = 16; ///< sample points per pattern in the hemisphere

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

template <typename F> std::array<float, OcclusionPattern::kPatterns> each_pattern(const F& f) {
    std::array<float, OcclusionPattern::kPatterns> result;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = f(static_cast<std::uint32_t>(i));
    return result;
}

/// Stores the sampling pattern of each pixel in an 8 × 8 block, row by row. The index is from a dither matrix: the
/// reversed bits of neighboring pixels' indices differ most (Bayer 1973, "An Optimum Method for Two-Level Rendition
/// of Continuous-Tone Pictures"). Aligned sub-blocks have consecutive indices, which are sub-nets of the net below.
const std::array<std::int32_t, OcclusionPattern::kPatterns> kPatternOfPixel = [] {
    std::array<std::int32_t, OcclusionPattern::kPatterns> result{};
    for (std::uint32_t pixel = 0; pixel < result.size(); ++pixel)
        for (std::uint32_t x = pixel % OcclusionPattern::kSide, y = pixel / OcclusionPattern::kSide, bit = 0; bit < 3;
             ++bit)
            result[pixel] |= static_cast<std::int32_t>((((x ^ y) >> bit & 1u) | (y >> bit & 1u) << 1) << 2 * bit);
    return result;
}();
/// For each pattern, these are the rotation of its lines and the jitter of its steps, in [0, 1). Together they form a
/// (0,2)-net.
const auto kRotation = each_pattern([](std::uint32_t i) { return sobol_net_point(i, OcclusionPattern::kPatterns).x; });
const auto kJitter = each_pattern([](std::uint32_t i) { return sobol_net_point(i, OcclusionPattern::kPatterns).y; });

/// Returns arccos with an error of at most 7e-5 (Abramowitz and Stegun 1964, 4.4.45).
Floats arc_cosine(const Floats& x) {
    const Floats a = min(abs(x), Floats(1.0f));
    const Floats polynomial = Floats(1.5707288f) + a *
        (Floats(-0.2121144f) + a * (Floats(0.0742610f) + a * Floats(-0.0187293f)));
    const Floats result = xsimd::sqrt(Floats(1.0f) - a) * polynomial;
    return xsimd::select(x < Floats(0.0f), Floats(kPi) - result, result);
}

Vec3s unit_of(const Vec3s& v) { return v * inverse_sqrt(max(dot(v, v), Floats(1e-30f))); }

/// Returns the index of a pixel, or of pixel 0 for positions outside. Images have up to 2^28 pixels, more than floats
/// can distinguish, so the index is an integer.
Ints pixel_index(const ScreenGBuffer& gbuffer, const Floats& x, const Floats& y, const Mask& inside) {
    const Floats none(0.0f);
    return truncated(xsimd::select(inside, y, none)) * Ints(gbuffer.width()) +
           truncated(xsimd::select(inside, x, none));
}

/// Stores integrals over the unoccluded arc from the viewer's direction, θ = 0, to a horizon, in the plane of v and
/// t. The projected normal is at the angle γ. `all` is ∫ cos(θ − γ) sin θ dθ; the others include the factors
/// cos θ and sin θ.
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

/// Finds the horizon along a line from each point: the greatest cosine to the viewer of any visible surface, at least
/// `lowest`.
class HorizonSearch {
public:
    HorizonSearch(const ScreenGBuffer& gbuffer, const OcclusionPoints& points, float radius, int steps)
        : gbuffer_(gbuffer), points_(points), homogeneous_(gbuffer.homogeneous(points.p)), radius_(radius),
          closest_(Floats(kClosest * kClosest) * dot(points.p, points.p)), steps_(steps) {
        const Floats over_w = Floats(1.0f) / homogeneous_[3];
        x_ = homogeneous_[0] * over_w, y_ = homogeneous_[1] * over_w;
    }

    /// `direction` is a unit vector perpendicular to the view.
    Floats operator()(const Vec3s& direction, const Floats& lowest, const Floats& jitter) const {
        const std::array<Floats, 4> change = gbuffer_.homogeneous_change(direction);
        const Floats over_w = Floats(1.0f) / homogeneous_[3];
        Floats step_x = (change[0] - x_ * change[3]) * over_w, step_y = (change[1] - y_ * change[3]) * over_w;
        const Floats speed = xsimd::sqrt(step_x * step_x + step_y * step_y),
                     per_pixel = Floats(1.0f) / max(speed, Floats(1e-20f));
        step_x *= per_pixel, step_y *= per_pixel;
        const Floats width(static_cast<float>(gbuffer_.width())), height(static_cast<float>(gbuffer_.height()));
        const Floats pixels =
            min(speed * Floats(radius_), min(to_edge(x_, step_x, width), to_edge(y_, step_y, height)));
        Floats highest = lowest;
        for (int i = 0; i < steps_; ++i) {
            const Floats fraction = (Floats(static_cast<float>(i)) + jitter) * Floats(1 / static_cast<float>(steps_));
            const Floats reach = Floats(1.0f) + fraction * fraction * pixels; // samples are denser near the point
            const Floats x = xsimd::floor(x_ + step_x * reach), y = xsimd::floor(y_ + step_y * reach);
            const Mask inside = (x >= Floats(0.0f)) & (y >= Floats(0.0f)) & (x < width) & (y < height);
            const Floats reversed_depth =
                gather(gbuffer_.reversed_depth().pixels().data(), pixel_index(gbuffer_, x, y, inside));
            const Vec3s to = gbuffer_.at(x, y, reversed_depth) - points_.p;
            const Floats squared = dot(to, to), over = inverse_sqrt(squared), distance = squared * over;
            const Mask counts = inside & (reversed_depth > Floats(0.0f)) & (squared > closest_) &
                                (distance < Floats(radius_)) & (dot(points_.n, to) >= Floats(kSlack) * distance);
            const Floats fade = max(distance * Floats(1 / (radius_ * (1 - kFadeFrom))) -
                                    Floats(kFadeFrom / (1 - kFadeFrom)), Floats(0.0f));
            const Floats cosine = dot(to, points_.to_viewer) * over;
            highest = xsimd::select(counts, max(highest, lerp(cosine, lowest, fade)), highest);
        }
        return highest;
    }

private:
    /// Returns the distance in pixels to the image's edge in a unit direction.
    static Floats to_edge(const Floats& at, const Floats& direction, const Floats& size) {
        const Floats end = xsimd::select(direction > Floats(0.0f), size, Floats(0.0f));
        return max(xsimd::select(direction == Floats(0.0f), Floats(1e9f), (end - at) / direction), Floats(0.0f));
    }
    const ScreenGBuffer& gbuffer_;
    const OcclusionPoints& points_;
    std::array<Floats, 4> homogeneous_;
    Floats x_, y_;
    float radius_;
    Floats closest_;
    int steps_;
};

/// Stores sample points in the hemisphere about +z, ordered by pattern.
struct HemispherePoints {
    std::array<std::array<float, OcclusionPattern::kPatterns>, kPoints> x, y, z;
};
const HemispherePoints& hemisphere_points() {
    static const HemispherePoints points = [] {
        HemispherePoints result;
        constexpr int kAll = OcclusionPattern::kPatterns * kPoints;
        for (std::uint32_t pattern = 0; pattern < OcclusionPattern::kPatterns; ++pattern)
            for (std::uint32_t i = 0; i < kPoints; ++i) {
                const std::uint32_t index = pattern * kPoints + i;
                const Vec2 u = sobol_net_point(index, kAll);
                const float fraction = (static_cast<float>(index * 77u % kAll) + 0.5f) / kAll;
                const Vec3 q = cosine_hemisphere(u) * sqr(fraction);
                result.x[i][pattern] = q.x, result.y[i][pattern] = q.y, result.z[i][pattern] = q.z;
            }
        return result;
    }();
    return points;
}

} // namespace

OcclusionPattern OcclusionPattern::of_row(int x, int y) {
    alignas(64) std::array<std::int32_t, Ints::size> which;
    for (std::size_t i = 0; i < Ints::size; ++i) {
        const int column = (x + static_cast<int>(i)) % kSide, row = y % kSide;
        which[i] = kPatternOfPixel[static_cast<std::size_t>(column + row * kSide)];
    }
    return {Ints::load_aligned(which.data())};
}
OcclusionPattern OcclusionPattern::of_point(int first) {
    return {truncated(load(kLanesAsFloats, 0)) + Ints(first)};
}

SkyVisibilityT<Floats> screen_space_occlusion(const ScreenGBuffer& gbuffer, const OcclusionPoints& points,
                                              const OcclusionPattern& pattern, float radius) {
    const FrameT<Floats> frame = frame_from_normal(points.n);
    const HemispherePoints& hemisphere = hemisphere_points();
    const Floats width(static_cast<float>(gbuffer.width())), height(static_cast<float>(gbuffer.height())), none(0.0f);
    const Floats closest = Floats(kClosest * kClosest) * dot(points.p, points.p);
    Floats hidden(0.0f);
    for (std::size_t i = 0; i < kPoints; ++i) {
        const Vec3s local{gather(hemisphere.x[i].data(), pattern.which), gather(hemisphere.y[i].data(), pattern.which),
                          gather(hemisphere.z[i].data(), pattern.which)};
        const auto [hx, hy, depth, w] = gbuffer.homogeneous(points.p + frame.to_world(local) * Floats(radius));
        const Floats x = xsimd::floor(hx / w), y = xsimd::floor(hy / w);
        const Mask inside = (depth > none) & (x >= none) & (y >= none) & (x < width) & (y < height);
        const Floats reversed_depth =
            gather(gbuffer.reversed_depth().pixels().data(), pixel_index(gbuffer, x, y, inside));
        const Vec3s to = gbuffer.at(x, y, reversed_depth) - points.p;
        // A surface far in front of the point hides it from the viewer, but blocks little of its light.
        const Floats squared = dot(to, to);
        const Mask hides = inside & (reversed_depth * depth > Floats(gbuffer.near())) & (squared > closest) &
                           (squared < Floats(radius * radius)) &
                           (dot(points.n, to) > Floats(kSlack) * xsimd::sqrt(squared));
        hidden += xsimd::select(hides, Floats(1.0f / kPoints), none);
    }
    return {Floats(1.0f) - hidden, points.n * (hidden * Floats(2.0f / 3))};
}

SkyVisibilityT<Floats> horizon_occlusion(const ScreenGBuffer& gbuffer, const OcclusionPoints& points,
                                         const OcclusionPattern& pattern, float radius, int lines, int steps) {
    const Vec3s v = points.to_viewer;
    const Floats one(1.0f), none(0.0f);
    const Vec3s n = unit_of(points.n + v * max(Floats(kMinCosine) - dot(points.n, v), none));
    const HorizonSearch search(gbuffer, points, radius, steps);
    const FrameT<Floats> frame = frame_from_normal(v);
    const Floats rotation = gather(kRotation.data(), pattern.which), jitter = gather(kJitter.data(), pattern.which);
    const Floats other_jitter = jitter + Floats(0.5f) - xsimd::select(jitter >= Floats(0.5f), one, none);
    Floats all(0.0f), lost(0.0f);
    Vec3s hidden{none, none, none};
    for (int i = 0; i < lines; ++i) {
        const Floats angle = (rotation + Floats(static_cast<float>(i))) * Floats(kPi / static_cast<float>(lines));
        const auto [sine, cosine] = xsimd::sincos(angle);
        const Vec3s t = frame.s * cosine + frame.t * sine, across = cross(v, t);
        const Vec3s in_plane = n - across * dot(n, across); // the normal projected to the plane of v and t
        const Floats size = xsimd::sqrt(dot(in_plane, in_plane)), over = one / max(size, Floats(1e-6f));
        const Floats cos_gamma = min(dot(in_plane, v) * over, one), sin_gamma = dot(in_plane, t) * over;
        const Floats turned = arc_cosine(cos_gamma), gamma = xsimd::select(sin_gamma < none, -turned, turned);
        all += size * (cos_gamma + gamma * sin_gamma);
        for (const float side : {1.0f, -1.0f}) {
            // `lowest` is the cosine of the tangent plane's horizon, π/2 from the normal.
            const Floats s = Floats(side) * sin_gamma, lowest = -s;
            const Floats highest = search(t * Floats(side), lowest, side > 0 ? jitter : other_jitter);
            const Arc open_arc = arc(Floats(kPi / 2) + Floats(side) * gamma, lowest, cos_gamma, cos_gamma, s);
            const Arc visible_arc =
                arc(arc_cosine(highest), highest, xsimd::sqrt(max(one - highest * highest, none)), cos_gamma, s);
            const auto less = [&](const Floats& whole, const Floats& fraction) { // exactly 0 if nothing is occluded
                return xsimd::select(highest > lowest, size * (whole - fraction), none);
            };
            lost += max(less(open_arc.all, visible_arc.all), none);
            hidden += v * less(open_arc.along_v, visible_arc.along_v) +
                      t * (Floats(side) * less(open_arc.along_t, visible_arc.along_t));
        }
    }
    const Floats over = xsimd::select(all > none, one / all, none);
    return {max(one - lost * over, none), hidden * over};
}

} // namespace duet::raster

#include "raster/shadows/light_views.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::raster {
namespace {

constexpr double kWidestSpot = 60; ///< degrees from the axis; beyond it the texel sizes of one map differ too much
constexpr double kStep = 4; ///< largest ratio of widths between successive views of a sun
constexpr std::size_t kMaxSteps = 4; ///< most views of a sun that are fixed to the scene, besides the widest
constexpr std::size_t kRanges = 3; ///< number of distance ranges with views of their own
constexpr double kFiner = 1.3; ///< a view must be this much finer than the next to get its own map

/// Returns the approximate width of the camera's view at its target, in meters.
double view_width(const Camera& camera) {
    const double distance = length(camera.look_at - camera.eye);
    return camera.projection == Camera::Projection::kOrthographic
               ? camera.height
               : 2 * distance * std::tan(radians(camera.fov_degrees) / 2);
}

Camera from_point(Vec3d eye, Vec3d direction, Vec3d up, double half_angle_tangent, double scene_size) {
    Camera camera;
    camera.eye = eye;
    camera.look_at = eye + direction * scene_size; // the near plane is a millionth of this distance away
    camera.up = up;
    camera.fov_degrees = degrees(2 * std::atan(half_angle_tangent));
    return camera;
}

/// Returns the factor by which a view widens to leave `guard` texels on each side.
double with_guard(int side, double guard) { return side / (side - 2 * guard); }

/// Represents a rectangle perpendicular to the sun's direction.
struct SunRect {
    Vec2d least{1e300, 1e300}, most{-1e300, -1e300};

    void extend(Vec2d p, double margin) {
        least = {min(least.x, p.x - margin), min(least.y, p.y - margin)};
        most = {max(most.x, p.x + margin), max(most.y, p.y + margin)};
    }
    bool contains(Vec3d p) const { return p.x >= least.x && p.x <= most.x && p.y >= least.y && p.y <= most.y; }
    Vec2d middle() const { return (least + most) * 0.5; }
    double width() const { return max(most.x - least.x, most.y - least.y); }
};

/// Returns one rectangle per distance range, widest first. Each bounds the visible points up to the range's end that
/// `casters` may shadow.
std::array<SunRect, kRanges> range_rects(std::span<const VisiblePoint> visible, const FrameT<double>& frame,
                                         const SunRect& casters) {
    double nearest = 1e300, farthest = 0;
    for (const VisiblePoint& s : visible)
        if (casters.contains(frame.to_local(s.p))) nearest = min(nearest, s.width), farthest = max(farthest, s.width);
    const double per_range = std::log(farthest / nearest) / kRanges;
    std::array<SunRect, kRanges> result;
    for (const VisiblePoint& s : visible) {
        const Vec3d p = frame.to_local(s.p);
        if (!casters.contains(p)) continue;
        const double range = per_range > 0 ? std::log(s.width / nearest) / per_range : 0;
        for (std::size_t i = 0; i < kRanges - std::min(static_cast<std::size_t>(range), kRanges - 1); ++i)
            result[i].extend({p.x, p.y}, 2 * s.width);
    }
    return result;
}

} // namespace

std::vector<Camera> sun_views(const SunLight& sun, double sine, const Box3& casters, const Camera& camera,
                              std::span<const VisiblePoint> visible, int side, double guard) {
    const Vec3d direction = normalize(Vec3d(sun.direction));
    const FrameT<double> frame = frame_from_normal(direction);
    SunRect whole;
    double first = 1e300, last = -1e300;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3d p = frame.to_local(Vec3d(casters.corner(corner)));
        whole.extend({p.x, p.y}, 0);
        first = min(first, p.z), last = max(last, p.z);
    }
    const double depth = last - first;
    if (sine > 0) {
        double deepest = last;
        for (const VisiblePoint& s : visible) deepest = max(deepest, dot(s.p, direction));
        // A penumbra reaches this far beyond the casters, and its points see what is as far beyond it.
        const double penumbra = sine * (deepest - first);
        const SunRect sharp = whole;
        whole.extend(sharp.least, 2 * penumbra), whole.extend(sharp.most, 2 * penumbra);
    }
    const double slack = 0.01 *
        (length(Vec3d(whole.most.x - whole.least.x, whole.most.y - whole.least.y, depth)) + 1e-30);
    const auto view = [&](Vec2d middle, double width) {
        Camera result;
        result.projection = Camera::Projection::kOrthographic;
        result.eye = frame.to_world({middle.x, middle.y, first - 2 * slack});
        result.look_at = result.eye + direction * (depth + slack);
        result.up = frame.t;
        result.height = width;
        result.near = slack;
        return result;
    };
    const double all = whole.width() + 2 * slack, finest = min(all, 2 * view_width(camera));
    std::vector<Camera> views;
    double narrowest = finest;
    for (const SunRect& rect : range_rects(visible, frame, whole)) {
        const double width = rect.width() * with_guard(side, guard);
        if (!(width > 0 && width * kFiner < narrowest)) continue;
        narrowest = width;
        views.push_back(view(rect.middle(), narrowest));
    }
    if (all > (views.empty() ? 1 : kFiner) * finest) {
        const Vec3d target = frame.to_local(camera.look_at);
        const auto steps = static_cast<std::size_t>(std::ceil(std::log(all / finest) / std::log(kStep)));
        const std::size_t count = std::min(steps, kMaxSteps);
        for (std::size_t i = 0; i < count; ++i)
            views.push_back(view({target.x, target.y},
                                 finest * std::pow(all / finest, static_cast<double>(i) / static_cast<double>(count))));
    }
    views.push_back(view(whole.middle(), all));
    std::ranges::stable_sort(views, {}, &Camera::height);
    return views;
}

std::vector<Camera> spot_views(const SpotLight& spot, double scene_size, int side, double guard) {
    const double angle = std::acos(std::clamp(static_cast<double>(spot.cos_outer), -1.0, 1.0));
    if (angle > radians(kWidestSpot)) return {};
    const Vec3d direction = normalize(Vec3d(spot.direction));
    return {from_point(Vec3d(spot.position), direction, frame_from_normal(direction).t,
                       std::tan(angle) * with_guard(side, guard), scene_size)};
}

std::vector<Camera> cube_views(Vec3d center, const FrameT<double>& frame, double scene_size, int side, double guard) {
    std::vector<Camera> views;
    const std::array<Vec3d, 3> axes{frame.s, frame.t, frame.n};
    for (std::size_t face = 0; face < 6; ++face) {
        const Vec3d axis = face % 2 == 0 ? axes[face / 2] : -axes[face / 2];
        views.push_back(from_point(center, axis, axes[(face / 2 + 1) % 3], with_guard(side, guard), scene_size));
    }
    return views;
}

} // namespace duet::raster

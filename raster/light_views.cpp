#include "raster/light_views.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::raster {
namespace {

constexpr double kWidestSpot = 60; ///< degrees from the axis: beyond it one picture's texels grow too unequal
constexpr double kStep = 4;        ///< from one of the sun's views to the next, at most
constexpr std::size_t kMostSunViews = 5;

/// About how wide the camera's picture is where it looks at.
double seen_width(const Camera& camera) {
    const double distance = length(camera.look_at - camera.eye);
    return camera.projection == Camera::Projection::kOrthographic ? camera.height
                                                                  : 2 * distance * std::tan(radians(camera.fov_degrees) / 2);
}

Camera from_point(Vec3d eye, Vec3d way, Vec3d up, double half_angle_tangent, double scene_size) {
    Camera camera;
    camera.eye = eye;
    camera.look_at = eye + way * scene_size; // the near plane is a millionth of that away
    camera.up = up;
    camera.fov_degrees = degrees(2 * std::atan(half_angle_tangent));
    return camera;
}

/// By how much a picture grows that keeps `guard` texels on each side.
double with_guard(int side, double guard) { return side / (side - 2 * guard); }

} // namespace

std::vector<Camera> sun_views(const SunLight& sun, const Box3& casters, const Camera& camera) {
    const Vec3d way = normalize(Vec3d(sun.direction)), low(casters.low), high(casters.high);
    const FrameT<double> frame = frame_from_normal(way);
    Vec3d least(1e300, 1e300, 1e300), most = -least;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3d p(corner & 1u ? high.x : low.x, corner & 2u ? high.y : low.y, corner & 4u ? high.z : low.z);
        least = min(least, frame.to_local(p));
        most = max(most, frame.to_local(p));
    }
    const double depth = most.z - least.z, slack = 0.01 * (length(most - least) + 1e-30);
    const auto view = [&](Vec3d middle, double width) {
        Camera result;
        result.projection = Camera::Projection::kOrthographic;
        result.eye = frame.to_world({middle.x, middle.y, least.z - 2 * slack});
        result.look_at = result.eye + way * (depth + slack);
        result.up = frame.t;
        result.height = width;
        result.near = slack;
        return result;
    };
    const double all = max(most.x - least.x, most.y - least.y) + 2 * slack;
    const double finest = min(all, 2 * seen_width(camera));
    const auto steps = static_cast<std::size_t>(std::ceil(std::log(all / finest) / std::log(kStep)));
    const std::size_t count = std::min(steps, kMostSunViews - 1);
    std::vector<Camera> views;
    for (std::size_t i = 0; i < count; ++i)
        views.push_back(view(frame.to_local(camera.look_at),
                             finest * std::pow(all / finest, static_cast<double>(i) / static_cast<double>(count))));
    views.push_back(view((least + most) * 0.5, all));
    return views;
}

std::vector<Camera> spot_views(const SpotLight& spot, double scene_size, int side, double guard) {
    const double angle = std::acos(std::clamp(static_cast<double>(spot.cos_outer), -1.0, 1.0));
    if (angle > radians(kWidestSpot)) return {};
    const Vec3d way = normalize(Vec3d(spot.direction));
    return {from_point(Vec3d(spot.position), way, frame_from_normal(way).t, std::tan(angle) * with_guard(side, guard),
                       scene_size)};
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

#include "common/camera/camera.h"

#include "common/sampling/warp.h"

#include <cmath>

namespace duet {

namespace {

// The nearest point with float coordinates. Both pipelines then see the scene, whose vertices are floats, from the very
// same point.
Vec3d rounded(Vec3d p) { return Vec3d(Vec3(p)); }

// A vector not parallel to `forward` to stand for an `up` that is.
Vec3d usable_up(Vec3d forward, Vec3d up) {
    const double sine_squared = length_squared(cross(forward, up));
    if (sine_squared > 1e-24 * length_squared(up)) return up;
    return std::abs(forward.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(0, 0, -1);
}

// The inverse of the pixel-to-ray map. For q = p − origin and camera coordinates c = (right·q, up·q, forward·q):
// perspective: c = w·(direction + x·dx + y·dy) with w = depth; orthographic: c = (x·dx, y·dy, depth) with w = 1.
Mat4d pixel_matrix(const Pinhole& view, Vec3d right, Vec3d up, bool orthographic) {
    const Vec3d dx = orthographic ? view.origin_dx : view.direction_dx;
    const Vec3d dy = orthographic ? view.origin_dy : view.direction_dy;
    const double pixels_right = 1 / dot(dx, right), pixels_up = 1 / dot(dy, up);
    const Vec3d skew = orthographic ? Vec3d() : Vec3d(dot(view.direction, right), dot(view.direction, up), 0);
    const Vec3d row_x = (right - view.forward * skew.x) * pixels_right;
    const Vec3d row_y = (up - view.forward * skew.y) * pixels_up;
    const auto row = [&](Vec3d r) { return std::array<double, 4>{r.x, r.y, r.z, -dot(r, view.origin)}; };
    Mat4d m;
    m[0] = row(row_x);
    m[1] = row(row_y);
    m[2] = row(view.forward);
    m[3] = orthographic ? std::array<double, 4>{0, 0, 0, 1} : m[2];
    return m;
}

} // namespace

Rayd Pinhole::ray(Vec2d pixel, double time) const {
    const Vec3d d = direction + direction_dx * pixel.x + direction_dy * pixel.y;
    const double per_depth = length(d); // distance along the ray for each unit of depth
    Rayd ray;
    ray.origin = origin + origin_dx * pixel.x + origin_dy * pixel.y;
    ray.direction = d / per_depth;
    ray.t_min = near * per_depth;
    ray.time = time;
    return ray;
}

Vec3d Pinhole::project(Vec3d p) const {
    const Vec4d h = world_to_pixel * Vec4d(p, 1.0);
    return {h.x / h.w, h.y / h.w, h.z};
}

CameraModel::CameraModel(const View& view)
    : aperture_radius_(view.camera.projection == Camera::Projection::kPerspective ? view.camera.aperture_radius : 0),
      focus_distance_(view.camera.focus_distance > 0 ? view.camera.focus_distance
                                                     : length(view.camera.look_at - view.camera.eye)),
      shutter_open_(view.camera.shutter_open), shutter_close_(view.camera.shutter_close) {
    const Camera& camera = view.camera;
    const bool orthographic = camera.projection == Camera::Projection::kOrthographic;
    const Vec3d eye = rounded(camera.eye);
    const Vec3d forward = normalize(camera.look_at - eye);
    right_ = normalize(cross(forward, usable_up(forward, camera.up)));
    up_ = cross(right_, forward);

    // Half the picture's extent, in metres (orthographic) or at unit depth (perspective).
    const double half_height = orthographic ? camera.height / 2 : std::tan(radians(camera.fov_degrees) / 2);
    const double half_width = half_height * view.width / view.height;
    const Vec3d corner = up_ * half_height - right_ * half_width;
    const Vec3d dx = right_ * (2 * half_width / view.width), dy = up_ * (-2 * half_height / view.height);

    center_.forward = forward;
    center_.near = camera.near_distance();
    if (orthographic) {
        center_.origin = rounded(eye + corner);
        center_.origin_dx = dx;
        center_.origin_dy = dy;
        center_.direction = forward;
    } else {
        center_.origin = eye;
        center_.direction = forward + corner;
        center_.direction_dx = dx;
        center_.direction_dy = dy;
    }
    center_.world_to_pixel = pixel_matrix(center_, right_, up_, orthographic);
}

// The lens point's offset from the centre, ending on float coordinates.
Vec3d CameraModel::lens_offset(Vec2d lens_sample) const {
    const Vec2d lens = Vec2d(concentric_disk(Vec2(lens_sample))) * aperture_radius_;
    return rounded(center_.origin + right_ * lens.x + up_ * lens.y) - center_.origin;
}

// Seen from another point of the lens, the plane in focus stays where it is: a pixel's ray goes to the point
// focus_distance · direction from the centre. (The offset has a tiny depth of its own, from rounding.)
Pinhole CameraModel::through(Vec2d lens_sample) const {
    if (!has_lens()) return center_;
    const Vec3d offset = lens_offset(lens_sample);
    const double depth = focus_distance_ - dot(offset, center_.forward);
    Pinhole view = center_;
    view.origin = center_.origin + offset;
    view.direction = (center_.direction * focus_distance_ - offset) / depth;
    view.direction_dx = center_.direction_dx * (focus_distance_ / depth);
    view.direction_dy = center_.direction_dy * (focus_distance_ / depth);
    view.world_to_pixel = pixel_matrix(view, right_, up_, false);
    return view;
}

Ray CameraModel::ray(Vec2d pixel, Vec2d lens_sample, double time_sample) const {
    Rayd exact;
    if (has_lens()) { // as through(), without the matrix
        const Vec3d offset = lens_offset(lens_sample);
        const Vec3d centered = center_.direction + center_.direction_dx * pixel.x + center_.direction_dy * pixel.y;
        const Vec3d d = (centered * focus_distance_ - offset) / (focus_distance_ - dot(offset, center_.forward));
        const double per_depth = length(d);
        exact = {center_.origin + offset, d / per_depth, center_.near * per_depth};
    } else {
        exact = center_.ray(pixel);
    }
    Ray ray;
    ray.origin = Vec3(exact.origin);
    ray.direction = Vec3(exact.direction);
    ray.t_min = static_cast<float>(exact.t_min);
    ray.time = static_cast<float>(time(time_sample));
    return ray;
}

double CameraModel::time(double time_sample) const { return lerp(shutter_open_, shutter_close_, time_sample); }

} // namespace duet

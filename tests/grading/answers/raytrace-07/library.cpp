// The library's camera (common/camera/camera.h) and its map to the disk (common/sampling/warp.h).
#include "common/camera/camera.h"
#include "common/sampling/warp.h"
#include "raytrace/lessons/07-camera/lab.h"

namespace duet::lab {

Axes camera_axes(Vec3 eye, Vec3 look_at, Vec3 up) {
    Camera camera;
    camera.eye = Vec3d(eye), camera.look_at = Vec3d(look_at), camera.up = Vec3d(up);
    const Pinhole view = CameraModel({camera, 1, 1}).pinhole();
    return {Vec3(normalize(view.direction_dx)), Vec3(normalize(-view.direction_dy)), Vec3(-view.forward)};
}

Vec3 pixel_direction(const Axes& axes, float fov_degrees, int width, int height, float x, float y) {
    Camera camera;
    camera.eye = {0, 0, 0}, camera.look_at = Vec3d(-axes.back), camera.up = Vec3d(axes.up);
    camera.fov_degrees = static_cast<double>(fov_degrees);
    return CameraModel({camera, width, height}).ray(Vec2d(Vec2(x, y))).direction;
}

Vec2 lens_point(Vec2 random) { return concentric_disk(random); }

// The library's thin lens starts from a sample, not from a point of the disk: its plane in focus, by hand.
Ray lens_ray(Vec3 eye, const Axes& axes, Vec3 direction, float aperture_radius, float focus_distance, Vec2 lens) {
    const Vec3d offset =
        (Vec3d(axes.right) * double(lens.x) + Vec3d(axes.up) * double(lens.y)) * double(aperture_radius);
    const Vec3d d = Vec3d(direction) * (double(focus_distance) / -dot(Vec3d(direction), Vec3d(axes.back)));
    return {Vec3(Vec3d(eye) + offset), Vec3(normalize(d - offset))};
}

} // namespace duet::lab
